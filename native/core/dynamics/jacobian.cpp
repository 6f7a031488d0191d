/// Columns of the Jacobian of a point P: a revolute joint at o gives ((P - o)', 1), a prismatic one along a
/// gives (a, 0), a floating base with origin o gives (1, 0, 0), (0, 1, 0) and ((P - o)', 1). Only joints
/// between the link and the ground have a column.

#include <haptics/core/dynamics/jacobian.hpp>

namespace haptics {
namespace {

/// Calls visit(freedom, column) for every column that is not zero.
template <class Visit>
void visit_columns(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
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

} // namespace

void point_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                    PointJacobian& jacobian) {
    jacobian.setZero(3, model.freedoms);
    visit_columns(model, data, link, point,
                  [&](int freedom, const Vec3& column) { jacobian.col(freedom) = column; });
}

Twist apply_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                     const JointVector& rates) {
    Twist twist = Twist::Zero();
    visit_columns(model, data, link, point,
                  [&](int freedom, const Vec3& column) { twist += rates[freedom] * column; });
    return twist;
}

void add_wrench(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                const Wrench& wrench, JointVector& force) {
    visit_columns(model, data, link, point,
                  [&](int freedom, const Vec3& column) { force[freedom] += column.dot(wrench); });
}

void direction_row(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                   const Vec3& direction, JointVector& row) {
    row.setZero(model.freedoms);
    add_wrench(model, data, link, point, direction, row);
}

} // namespace haptics
