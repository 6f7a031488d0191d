#pragma once
/// Acceleration feed-forward: device and proxy are given what makes them accelerate alike in free motion.

#include <haptics/core/types.hpp>

namespace haptics {

/// What device and proxy receive beside the coupling, and the acceleration both then have.
struct SharedMotion {
    Wrench to_device{0.0, 0.0, 0.0};
    Wrench to_proxy{0.0, 0.0, 0.0};
    Vec3 acceleration{0.0, 0.0, 0.0};
};

/// `mobility` is the proxy's J_h D^-1 J_h^T (may be singular) and `free_acceleration` that of its grip when
/// neither hand nor contact acts; `device_mass` is the handle's mass matrix and `visible_mass` the part of it
/// that the hand is to feel; `hand_force` acts on the handle.
SharedMotion share_motion(const Mat3& mobility, const Vec3& free_acceleration, const Mat3& device_mass,
                          const Mat3& visible_mass, const Wrench& hand_force);

/// The device's mass with the parts `hidden` of it (0..1 per freedom) taken out, as W M W with W = diag(sqrt(1
/// - hidden)): positive semidefinite for every M that is.
Mat3 visible_mass(const Mat3& device_mass, const Vec3& hidden);

} // namespace haptics
