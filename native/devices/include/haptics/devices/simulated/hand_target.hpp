#pragma once
/// Where the mouse wants the hand.

#include <haptics/core/types.hpp>

namespace haptics {

/// One target of a simulated hand, made by the scene once a frame, used on the loop thread.
struct HandTarget {
    /// When the pose was taken, on the simulated device's clock (s, starts at 0 and passes with `advance`).
    double time_s{0.0};
    /// Wanted handle pose, device frame (m, m, rad, not wrapped).
    Pose pose{0.0, 0.0, 0.0};
};

} // namespace haptics
