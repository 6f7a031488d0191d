#pragma once
/// From the device's workspace to the scene and back: x_scene = s R x_device + o. Power-conjugate: F_device =
/// s R^T F_scene, so that a wall of stiffness K feels like s^2 K at the handle. Angles and torques are not
/// scaled.

#include <haptics/core/types.hpp>

namespace haptics {

struct Mapping {
    /// Meters in the scene per meter at the device, > 0.
    double scale{1.0};
    /// Turn of the device's axes in the scene, rad.
    double rotation{0.0};
    /// Scene point of the device's origin, and angle added to the handle's, m and rad.
    Pose offset{0.0, 0.0, 0.0};

    [[nodiscard]] Pose to_scene(const Pose& device) const {
        const Vec2 p = scale * rotate(rotation, device.head<2>()) + offset.head<2>();
        return {p.x(), p.y(), device.z() + rotation + offset.z()};
    }
    [[nodiscard]] Pose to_device(const Pose& scene) const {
        const Vec2 p = rotate(-rotation, scene.head<2>() - offset.head<2>()) / scale;
        return {p.x(), p.y(), scene.z() - rotation - offset.z()};
    }
    [[nodiscard]] Twist twist_to_scene(const Twist& device) const {
        const Vec2 v = scale * rotate(rotation, device.head<2>());
        return {v.x(), v.y(), device.z()};
    }
    [[nodiscard]] Twist twist_to_device(const Twist& scene) const {
        const Vec2 v = rotate(-rotation, scene.head<2>()) / scale;
        return {v.x(), v.y(), scene.z()};
    }
    [[nodiscard]] Wrench wrench_to_device(const Wrench& scene) const {
        const Vec2 f = scale * rotate(-rotation, scene.head<2>());
        return {f.x(), f.y(), scene.z()};
    }
    [[nodiscard]] Wrench wrench_to_scene(const Wrench& device) const {
        const Vec2 f = rotate(rotation, device.head<2>()) / scale;
        return {f.x(), f.y(), device.z()};
    }
    /// The device's mass matrix as the scene sees it: A^-T M A^-1 for the velocity map A.
    [[nodiscard]] Mat3 mass_to_scene(const Mat3& device) const {
        Mat3 inverse = Mat3::Identity(); // scene velocity -> device velocity
        inverse.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-rotation).toRotationMatrix() / scale;
        return inverse.transpose() * device * inverse;
    }
};

} // namespace haptics
