#pragma once
/// Velocity from coarse encoders.

#include <haptics/core/types.hpp>

#include <array>

namespace haptics {

/// First-order adaptive windowing (Janabi-Sharifi, Hayward and Chen 2000), each coordinate on its own: the
/// longest straight line back from the newest sample that explains all samples between within the encoder's
/// error. Slow motion gets a long window and little noise, fast motion a short one and little lag. Nothing
/// allocates.
class VelocityEstimator {
  public:
    /// Longest window in samples.
    static constexpr int k_capacity = 64;

    /// `error`: largest reading error of each coordinate (m, m, rad), half an encoder step or more; negative
    /// counts as 0. `window`: longest window in samples, 1 to k_capacity - 1.
    explicit VelocityEstimator(const Vec3& error, int window = 20);

    /// Forgets all samples; the next estimate is zero.
    void reset();
    /// Takes the sample `pose` (m, rad) at `dt` s after the last one; returns the velocity (m/s, rad/s). A
    /// sample that is not finite or a dt that is not positive is ignored: the last estimate stays.
    Twist update(const Pose& pose, double dt);
    /// The last estimate.
    [[nodiscard]] const Twist& velocity() const { return velocity_; }
    /// Samples spanned by the last estimate of each coordinate.
    [[nodiscard]] const std::array<int, 3>& window() const { return used_; }

  private:
    struct Sample {
        Pose pose{0.0, 0.0, 0.0};
        double time{0.0};
    };
    [[nodiscard]] const Sample& back(int age) const;

    Vec3 error_;
    int window_;
    std::array<Sample, k_capacity> ring_{};
    int newest_{-1};
    int count_{0};
    Twist velocity_{0.0, 0.0, 0.0};
    std::array<int, 3> used_{0, 0, 0};
};

} // namespace haptics
