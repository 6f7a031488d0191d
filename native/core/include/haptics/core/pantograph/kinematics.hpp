#pragma once
/// Where the handle is and how it moves: forward and inverse kinematics, Jacobian, workspace of a planar
/// pantograph.

#include <haptics/core/pantograph/geometry.hpp>
#include <haptics/core/types.hpp>

#include <array>

namespace haptics {

/// Joint angles, rates or torques; entries past the motors in use are zero. Order: bar 0 leg 0, bar 0 leg 1,
/// bar 1 leg 0, ...
using JointVector = Eigen::Vector4d;
/// Joint rates per handle twist (rad/s per m/s and rad/s); rows past the motors in use are zero, so is column
/// 2 with two freedoms.
using JointJacobian = Eigen::Matrix<double, 4, 3>;

/// One leg at a given handle pose (device frame, m).
struct LegState {
    Vec2 base{0.0, 0.0};
    /// From motor axis to elbow.
    Vec2 proximal{1.0, 0.0};
    /// From elbow to end point.
    Vec2 distal{0.0, 1.0};
    /// From the handle's reference point to the end point.
    Vec2 arm{0.0, 0.0};
};

/// The linkage at one handle pose. Always finite; where the pose cannot be reached the nearest stretch of
/// each leg is given.
struct PantographState {
    /// The pose located, m, rad.
    Pose pose{0.0, 0.0, 0.0};
    std::array<LegState, k_max_motors> leg{};
    /// Joint rates = rates * twist; wrench = rates^T * joint torques.
    JointJacobian rates{JointJacobian::Zero()};
    /// True when every leg reaches its end point.
    bool closed{false};
    /// True when they do in front of their motors, and both five-bars are in their assembly mode.
    bool reachable{false};
    /// Least distance of an end point to the edge of its annulus of reach or to the line of its motors, m;
    /// negative outside.
    double reach_margin{0.0};
};

/// Pose by least squares over the encoders.
struct PoseEstimate {
    Pose pose{0.0, 0.0, 0.0};
    /// Joint angles less those of `pose`, rad, each in [-pi, pi]: what no pose explains. Zero for a single
    /// five-bar (two encoders, two freedoms).
    JointVector misfit{JointVector::Zero()};
    /// Norm of `misfit`, rad.
    double residual{0.0};
    /// False when the angles belong to no pose in the working and assembly mode of the geometry (also when
    /// the residual exceeds 0.25 rad); `pose` is then finite but not to be trusted.
    bool valid{false};
};

/// How far a pose is from trouble.
struct WorkspaceReport {
    /// Reachable, in the assembly mode, and within the rotation stop.
    bool inside{false};
    /// Distance to the edge of reach, m (stretched or folded arm); negative outside.
    double reach_margin{0.0};
    /// Angle to the rotation stop, rad; pi with two freedoms.
    double rotation_margin{0.0};
    /// Smallest singular value of the unit lines of the distal links (moments over the handle's half width):
    /// 0 where some wrench cannot be held whatever the torques, 1 for a single five-bar at a right angle. For
    /// a twin also at most that of each five-bar alone, since beyond 0 there it would leave its assembly
    /// mode.
    double singularity{0.0};
};

/// Kinematics of one geometry. Plain data, copyable; nothing here allocates, throws or yields NaN, whatever
/// the input.
class PantographKinematics {
  public:
    /// `geometry` is expected to pass `validate`.
    explicit PantographKinematics(const PantographGeometry& geometry);

    /// The figures this was made from.
    [[nodiscard]] const PantographGeometry& geometry() const { return geometry_; }
    /// 2 or 3.
    [[nodiscard]] int freedoms() const { return geometry_.freedoms(); }
    /// 2 or 4.
    [[nodiscard]] int motors() const { return geometry_.motors(); }

    /// The linkage at `pose` (m, rad): elbows, Jacobian, reach.
    [[nodiscard]] PantographState locate(const Pose& pose) const;
    /// Joint angles at `pose`, rad, in (-pi, pi]. False (and the nearest finite angles) when out of reach.
    bool inverse(const Pose& pose, JointVector& angles) const;
    /// Pose from joint angles (rad, any turn): circle intersections, refined by least squares over all
    /// encoders.
    [[nodiscard]] PoseEstimate forward(const JointVector& angles) const;
    /// Twist per joint rates: the exact inverse for two motors, the least-squares inverse of `rates` for
    /// four. Zero at singularities.
    [[nodiscard]] Eigen::Matrix<double, 3, 4> jacobian(const PantographState& state) const;
    /// The direction of joint angles that no motion explains: unit, orthogonal to the three columns of
    /// `rates`, smooth along every path without a singularity. Also the torques that the linkage bears within
    /// itself. Zero for a single five-bar and where it is not unique.
    [[nodiscard]] JointVector unexplained(const PantographState& state) const;
    /// Margins of `pose` (with the state that `locate` gave for it).
    [[nodiscard]] WorkspaceReport workspace(const Pose& pose, const PantographState& state) const;
    /// Margins of `pose`.
    [[nodiscard]] WorkspaceReport workspace(const Pose& pose) const { return workspace(pose, locate(pose)); }
    /// Length that makes moments comparable with forces, m: half the distance of the attachments; 1 with two
    /// freedoms.
    [[nodiscard]] double characteristic_length() const { return length_; }

    /// Joint angle of encoder count `count` on axis i, rad.
    [[nodiscard]] double angle_of_count(int i, double count) const;
    /// Encoder count (not rounded) of joint angle `angle` on axis i.
    [[nodiscard]] double count_of_angle(int i, double angle) const;

  private:
    [[nodiscard]] Pose refinement(const PantographState& state, const JointVector& misfit) const;
    [[nodiscard]] JointVector misfit(const PantographState& state, const JointVector& angles) const;

    PantographGeometry geometry_;
    std::array<Vec2, k_max_motors> base_;
    std::array<Vec2, 2> front_;
    double length_;
};

} // namespace haptics
