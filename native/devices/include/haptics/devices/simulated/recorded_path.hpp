#pragma once
/// A hand motion given as a table.

#include <haptics/devices/simulated/hand_target.hpp>

#include <vector>

namespace haptics {

/// Between the points of a recorded path.
enum class PathInterpolation {
    linear, ///< straight lines; velocity jumps at the points
    smooth, ///< cubic Hermite through the points; velocity is continuous
};

/// Pose and velocity of a path at one time.
struct PathSample {
    Pose pose{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
};

/// Time-pose table. Rests at the first point before it and at the last after it, or starts over.
class RecordedPath {
  public:
    RecordedPath() = default;
    /// `points` with times growing strictly; `repeat` starts over after the last point (which should equal
    /// the first).
    RecordedPath(std::vector<HandTarget> points, PathInterpolation interpolation, bool repeat);

    /// The path at `time` s. Constant time when time grows from call to call. Does not allocate.
    [[nodiscard]] PathSample sample(double time);
    /// True when there is no point.
    [[nodiscard]] bool empty() const { return points_.empty(); }
    /// Time of the last point, s.
    [[nodiscard]] double end() const { return points_.empty() ? 0.0 : points_.back().time_s; }

  private:
    [[nodiscard]] Twist tangent(std::size_t i) const;

    std::vector<HandTarget> points_;
    PathInterpolation interpolation_{PathInterpolation::linear};
    bool repeat_{false};
    std::size_t cursor_{0};
};

} // namespace haptics
