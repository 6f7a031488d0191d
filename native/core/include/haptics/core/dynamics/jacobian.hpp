#pragma once
/// Jacobian of a point on a link: the velocity (x, y, theta) of the material point of `link` at the scene
/// position `point` is J q'. All functions want update_positions().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// 3 x freedoms, inline storage.
using PointJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, k_max_freedoms>;

/// Dense J.
void point_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                    PointJacobian& jacobian);
/// J w for any joint rates w, without forming J: O(depth).
[[nodiscard]] Twist apply_jacobian(const LinkageModel& model, const LinkageData& data, int link,
                                   const Vec2& point, const JointVector& rates);
/// force += J^T wrench, without forming J: O(depth).
void add_wrench(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                const Wrench& wrench, JointVector& force);
/// row = direction^T J (a contact row): `direction` weighs x, y and theta.
void direction_row(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                   const Vec3& direction, JointVector& row);

} // namespace haptics
