#pragma once
/// Vectors, poses and the few planar operations that every room uses. SI units, y up, angles
/// counter-clockwise.

#include <Eigen/Dense>
#include <cmath>

namespace haptics {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

/// Planar pose (x in m, y in m, theta in rad; theta is not wrapped).
using Pose = Vec3;
/// Planar velocity of a body's reference point (m/s, m/s, rad/s).
using Twist = Vec3;
/// Planar force and torque about a body's reference point (N, N, N m).
using Wrench = Vec3;

/// z component of a x b.
inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}
/// v turned by +90 degrees.
inline Vec2 perpendicular(const Vec2& v) {
    return {-v.y(), v.x()};
}
/// v turned by `angle` (rad).
inline Vec2 rotate(double angle, const Vec2& v) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}
/// A pose with its sine and cosine taken once: use it where many points are moved by the same pose.
struct Transform {
    Vec2 origin{0.0, 0.0};
    double cosine{1.0};
    double sine{0.0};

    Transform() = default;
    explicit Transform(const Pose& pose)
        : origin(pose.head<2>())
        , cosine(std::cos(pose.z()))
        , sine(std::sin(pose.z())) {}

    /// Direction from body to scene axes.
    [[nodiscard]] Vec2 turn(const Vec2& v) const {
        return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
    }
    /// Direction from scene to body axes.
    [[nodiscard]] Vec2 turn_back(const Vec2& v) const {
        return {cosine * v.x() + sine * v.y(), -sine * v.x() + cosine * v.y()};
    }
    /// Point from body to scene.
    [[nodiscard]] Vec2 apply(const Vec2& p) const { return origin + turn(p); }
    /// Point from scene to body.
    [[nodiscard]] Vec2 apply_inverse(const Vec2& p) const { return turn_back(p - origin); }
};

/// Velocity of the point at `arm` (scene axes, from the body's reference point).
inline Vec2 velocity_at(const Twist& twist, const Vec2& arm) {
    return twist.head<2>() + twist.z() * perpendicular(arm);
}

} // namespace haptics
