#pragma once
/// Jacobian of a point on a link: the velocity (x, y, theta) of the material point of `link` at the scene
/// position `point` is J q'. All functions want update_positions().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// 3 x freedoms, inline storage.
using PointJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, k_max_freedoms>;

/// Calls visit(freedom, column) for every column of J that is not zero: a revolute joint at o gives
/// ((point - o)', 1), a prismatic one along a gives (a, 0), a floating base with origin o gives (1, 0, 0),
/// (0, 1, 0) and ((point - o)', 1). Only joints between the link and the ground have a column.
template <class Visit>
void visit_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                    const Visit& visit) {
    for (int slot = model.link[link].slot; slot > 0; slot = model.body[slot].parent) {
        const BodyModel& body = model.body[slot];
        if (body.joint == BodyJoint::prismatic) {
            visit(body.freedom, Vec3(data.axis_x[slot], data.axis_y[slot], 0.0));
            continue;
        }
        const Vec3 turning(data.y[slot] - point.y(), point.x() - data.x[slot], 1.0);
        if (body.joint == BodyJoint::revolute) {
            visit(body.freedom, turning);
        } else {
            visit(0, Vec3(1.0, 0.0, 0.0));
            visit(1, Vec3(0.0, 1.0, 0.0));
            visit(2, turning);
        }
    }
}

/// Dense J.
void point_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                    PointJacobian& jacobian);
/// J w for any joint rates w, without forming J: O(depth).
[[nodiscard]] Twist apply_jacobian(const LinkageModel& model, const LinkageData& data, int link,
                                   const Vec2& point, const LinkageVector& rates);
/// force += J^T wrench, without forming J: O(depth).
void add_wrench(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                const Wrench& wrench, LinkageVector& force);
/// row = direction^T J (a contact row): `direction` weighs x, y and theta.
void direction_row(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                   const Vec3& direction, LinkageVector& row);

} // namespace haptics
