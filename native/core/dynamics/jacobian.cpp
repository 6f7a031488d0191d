#include <haptics/core/dynamics/jacobian.hpp>

namespace haptics {

void point_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                    PointJacobian& jacobian) {
    jacobian.setZero(3, model.freedoms);
    visit_jacobian(model, data, link, point,
                   [&](int freedom, const Vec3& column) { jacobian.col(freedom) = column; });
}

Twist apply_jacobian(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                     const LinkageVector& rates) {
    Twist twist = Twist::Zero();
    visit_jacobian(model, data, link, point,
                   [&](int freedom, const Vec3& column) { twist += rates[freedom] * column; });
    return twist;
}

void add_wrench(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                const Wrench& wrench, LinkageVector& force) {
    visit_jacobian(model, data, link, point,
                   [&](int freedom, const Vec3& column) { force[freedom] += column.dot(wrench); });
}

void direction_row(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point,
                   const Vec3& direction, LinkageVector& row) {
    row.setZero(model.freedoms);
    add_wrench(model, data, link, point, direction, row);
}

} // namespace haptics
