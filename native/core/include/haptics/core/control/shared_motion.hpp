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

/// How much of the device's inertia is hidden, as parts of it, 0..1.
struct HiddenInertia {
    /// Beside a proxy without mass, per freedom: what the loop bears.
    Vec3 alone{0.0, 0.0, 0.0};
    /// The most, beside a proxy that has mass enough of its own.
    double most{0.0};
};

/// The part of the device's mass that the hand is to feel beside a proxy of this mobility, times `amount` of
/// hiding (0: all of it is felt). Symmetric, positive semidefinite, at most the device's mass.
Mat3 visible_mass(const Mat3& device_mass, const Mat3& mobility, const HiddenInertia& hidden, double amount);

/// The same for one freedom and a proxy of r times the device's mass: the visible part.
double visible_part(double alone, double most, double r);

} // namespace haptics
