#pragma once
/// What of the scene goes into a snapshot: the pieces within reach of what the user holds, the nearest first
/// where there are too many. A level drawn as one body of a thousand pieces costs the haptic step no more
/// than the few that are near.

#include <haptics/core/contact/bounds.hpp>

#include <span>

namespace haptics {

/// A disc in scene axes (m) whose surroundings matter.
struct ReachDisc {
    Vec2 center{0.0, 0.0};
    double radius{0.0};
};

/// A body that may be near, with all its pieces and their bounds (same count).
struct Candidate {
    Body body;
    std::span<const Piece> pieces;
    std::span<const PieceBounds> bounds;
};

/// What select_near left out because the set was full; nothing of it may be near in a sound scene.
struct LeftOut {
    std::int32_t bodies{0};
    std::int32_t pieces{0};
};

/// Distance of a point (scene axes) from the box of a piece of a body at `pose`, m, 0 inside.
[[nodiscard]] double distance_to(const PieceBounds& bounds, const Pose& pose, const Vec2& point);

/// Fills `out` with the bodies, in the order given, that have a piece within a disc, and with those pieces;
/// a movable body comes with all its pieces. No discs: everything is near. Where bodies or pieces are more
/// than a set holds, the nearest stay. Off the haptic loop; allocates.
LeftOut select_near(std::span<const Candidate> candidates, std::span<const ReachDisc> discs, BodySet& out);

} // namespace haptics
