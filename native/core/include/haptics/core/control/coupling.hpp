#pragma once
/// How device and proxy are tied together.

#include <haptics/core/types.hpp>

#include <cstdint>

namespace haptics {

/// What is exchanged between device and proxy.
enum class Coupling : std::uint8_t {
    four_channel,     ///< positions and forces, both ways (the paper's controller); positions alone while the
                      ///< device measures no force
    virtual_coupling, ///< positions only: a spring-damper between device and proxy
    direct,           ///< no proxy: contact forces at the device's own pose (baseline)
};

/// How contact forces and impulses in configuration space become forces at the hand.
enum class HandForce : std::uint8_t {
    /// Device and proxy share the grip: S J_h D^-1 tau with S = (J_h D^-1 J_h^T + M_d^-1)^-1. Safe where the
    /// linkage cannot move.
    combined,
    /// Eqs (3) and (7): the dynamically consistent inverse of J_h (Khatib 1995), truncated. Unstable for
    /// proxies
    /// much heavier than the device. For comparison.
    paper,
    /// Acceleration feed-forward (shared_motion.cpp): in free motion device and proxy are given what makes
    /// them accelerate alike, and part of the device's inertia can be hidden; contact forces come through the
    /// coupling. Needs a measured or observed hand force and `four_channel`.
    transparent,
};

/// Spring and damper between handle and grip, per freedom.
struct CouplingGains {
    Vec3 stiffness{0.0, 0.0, 0.0}; ///< N/m, N/m, N m/rad
    Vec3 damping{0.0, 0.0, 0.0};   ///< N s/m, N s/m, N m s/rad
};

/// Largest coupling that the sampled loop holds with a comfortable margin (derivation in coupling.cpp).
/// `device_mass` is the handle's mass matrix in scene axes; `mobility` the proxy's J_h D^-1 J_h^T when forces
/// are fed forward (four channels), zero otherwise; `period` that of the device's samples or of the loop, the
/// longer one, s; `delay` what the device adds, in s; `velocity_window` that of the velocity estimate,
/// samples.
CouplingGains default_gains(const Mat3& device_mass, const Mat3& mobility, double period, double delay,
                            int velocity_window);

/// Window of the velocity estimate, samples.
struct VelocityWindow {
    int longest{2};
    /// What default_gains has to provide for: the longest is taken only where nothing but noise moves.
    int lag{2};
};

/// The shortest window in which a step of the encoder, come and gone, makes a force whose standard deviation,
/// through the damping of default_gains, is at most `noise` N (and `noise_torque` N m); at most 63 samples.
/// `encoder_step` per coordinate, m, m, rad.
VelocityWindow choose_velocity_window(const Mat3& device_mass, const Mat3& mobility, double period,
                                      double delay, const Vec3& encoder_step, double noise,
                                      double noise_torque);

/// Mass of the handle in the direction in which it is lightest, kg; the coupling feels the same all around.
double lightest_mass(const Mat3& device_mass);

/// S = (J_h D^-1 J_h^T + M_d^-1)^-1: what device and proxy weigh together, seen at the grip. Finite where J_h
/// D^-1 J_h^T is singular.
Mat3 combined_mass(const Mat3& grip_mobility, const Mat3& device_mass);

/// What the force channels do for the motion of device and tool (coupling.cpp).
struct LentMass {
    /// Inertia at handle and grip that is kept from the hand: the channels pay for its motion and get it
    /// back.
    Mat3 device{Mat3::Zero()};
    Mat3 tool{Mat3::Zero()};
    /// Part of the device's friction that they carry where the hand's force is measured.
    Mat3 friction{Mat3::Zero()};
};
/// In the S form; `share`: the part of the forces that takes effect, 0..1.
LentMass lent_mass(const Mat3& grip_mobility, const Mat3& device_mass, double share);
/// In acceleration feed-forward, with `hidden` of the device's mass kept from the hand.
LentMass lent_mass_hidden(const Mat3& grip_mobility, const Mat3& device_mass, const Mat3& hidden);

/// (J_h D^-1 J_h^T)^-1, the mass of the proxy at the grip, in the directions in which it is less than 25
/// times the device's; above 50 times, and where the linkage cannot move at all, zero; between the two a
/// smooth passage.
Mat3 truncated_mass(const Mat3& grip_mobility, const Mat3& device_mass);

} // namespace haptics
