#pragma once
/// Tells when an encoder of a twin pantograph has slipped: four encoders, three freedoms, one direction in
/// which they can contradict one another.

#include <haptics/core/figure_error.hpp>
#include <haptics/core/pantograph/kinematics.hpp>

#include <array>
#include <vector>

namespace haptics {

/// What an honest device may be off by. Larger values hide more of a slip, smaller ones cry wolf.
struct EncoderCheckSettings {
    /// Largest error of one reading, counts, 0.5 (perfect lines, rounding alone) to 20.
    double reading_error{0.75};
    /// Largest error of an encoder's zero after homing, rad, 0 to 0.1.
    double offset_tolerance{1.0e-3};
    /// Largest error of a link's length, of a motor axis' place and of an attachment's place (each
    /// coordinate), m, 0 to 0.01.
    double length_tolerance{1.0e-4};
    /// Largest time between the samples of two encoders of one reading, s, 0 to 1e-3.
    double sampling_skew{1.0e-6};
    /// Readings in a row that must contradict, 1 to 20: one torn reading is no slip.
    int patience{3};
};

/// Every setting out of range, with its remedy. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const EncoderCheckSettings& settings);

/// Compares every reading with readings of a moment ago and with some from all over the workspace since
/// homing: each pair must be explained by rounding and by what the settings allow. The bound of a pair is the
/// exact worst case to first order, so that an honest device within the settings raises no alarm; at one pose
/// the bound is a few counts (see smallest_slip). A single five-bar has nothing to compare: every pair of
/// angles is a pose. Loop thread only; nothing allocates.
class EncoderCheck {
  public:
    /// Readings of a moment ago, and from all over, that are kept.
    static constexpr int k_recent = 16;
    static constexpr int k_landmarks = 48;

    explicit EncoderCheck(const PantographKinematics& kinematics, const EncoderCheckSettings& settings = {});

    /// False for a single five-bar: a slip cannot be seen there.
    [[nodiscard]] bool possible() const { return kinematics_.freedoms() == 3; }
    /// Forgets everything, a slip too: after the device was homed.
    void reset();
    /// One reading: the joint angles (rad) and what `forward` made of them, `dt` s after the last. Returns
    /// slipped().
    bool update(const JointVector& angles, const PoseEstimate& estimate, double dt);
    /// True from the moment a slip is sure until reset.
    [[nodiscard]] bool slipped() const { return slipped_; }

    /// What the encoders contradict one another by in the last reading, rad; its sign is smooth along a path.
    [[nodiscard]] double residual() const { return residual_; }
    /// Largest share of its bound that a comparison of the last reading used: above 1 is a contradiction.
    [[nodiscard]] double strain() const { return strain_; }
    /// Least slip of encoder i, rad, from which on every slip up to 0.05 rad is seen when it happens now,
    /// with the handle at rest and the encoders at `angles` (rad); infinite where some such slip looks like a
    /// motion of the handle, and for a single five-bar. Takes milliseconds; not for the haptic loop.
    [[nodiscard]] double smallest_slip(const JointVector& angles, int i) const;

  private:
    // 4 zeros; length of both links and both coordinates of the axis of each leg; both coordinates of each
    // attachment
    static constexpr int k_causes = 4 + 4 * 4 + 2 * 2;
    using Causes = Eigen::Matrix<double, k_causes, 1>;
    struct Reading {
        double residual{0.0};
        /// Sum of what an error of one radian of each encoder would add, 1 to 2.
        double weight{0.0};
        /// Rounding and skew, rad.
        double noise{0.0};
        /// What each cause at its tolerance would add to the residual, rad.
        Causes causes{Causes::Zero()};
        JointVector angles{JointVector::Zero()};
    };
    /// False where a reading says nothing.
    bool describe(const JointVector& angles, const PoseEstimate& estimate, Reading& reading) const;
    [[nodiscard]] double strain_against(const Reading& now, const Reading& then) const;
    void keep(const Reading& reading);

    PantographKinematics kinematics_;
    EncoderCheckSettings settings_;
    double count_;
    std::array<Reading, k_recent> recent_{};
    std::array<Reading, k_landmarks> landmark_{};
    int recent_count_{0};
    int newest_{0};
    int landmark_count_{0};
    JointVector last_angles_{JointVector::Zero()};
    bool has_last_{false};
    int against_{0};
    double residual_{0.0};
    double strain_{0.0};
    bool slipped_{false};
};

} // namespace haptics
