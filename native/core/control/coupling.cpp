// Gains of the coupling.
//
// Worst case for the spring between handle and proxy is a proxy that stands still (a hard wall): the device's mass m alone moves on K, B
// through a loop that samples (the force is held for a step: T/2 on average), computes (one step: T) and takes velocity from
// differences (T/2): tau = 2 T plus the device's own delay. With L(s) = (B s + K) e^(-s tau) / (m s^2), K = m w^2 and B = 2 z m w, the gain crosses one at
// w_c = w sqrt(2 z^2 + sqrt(4 z^4 + 1)), that is 1.55 w for z = 0.7, where the phase margin is atan(2 z w_c / w) - w_c tau = 65 deg - 1.55 w tau.
// Asking for 39 deg leaves w tau = 0.29: w = 0.29 / tau, i.e. w T = 0.145 without delay. For 0.3 kg at 500 Hz this is 1577 N/m and 30.5 N s/m.
//
// S form. Device M_d a = F_h + L and proxy D q'' = tau - J_h^T L share the grip, J_h q'' = a, so L = S (J_h D^-1 tau - M_d^-1 F_h) with
// S = (J_h D^-1 J_h^T + M_d^-1)^-1. The device is fed forward S J_h D^-1 tau, the proxy S J_h D^-1 J_h^T F_h (note 1 - S M_d^-1 =
// S J_h D^-1 J_h^T). At rest the sum of both equations says (1 + S J_h D^-1 J_h^T)(F_h + F_env) = 0: a steady push gives the push back, whatever the masses.

#include <haptics/core/control/coupling.hpp>

#include <algorithm>

namespace haptics {

CouplingGains default_gains(const Mat3& device_mass, double step, double delay) {
    constexpr double k_frequency = 0.29; // w tau
    constexpr double k_damping_ratio = 0.7;
    const double w = k_frequency / (2.0 * step + std::max(delay, 0.0));
    CouplingGains gains;
    // the lightest direction bounds both axes, so that the coupling feels the same all around
    const double xx = device_mass(0, 0);
    const double yy = device_mass(1, 1);
    const double xy = device_mass(0, 1);
    const double lightest = 0.5 * (xx + yy) - std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const Vec3 mass(lightest, lightest, device_mass(2, 2));
    gains.stiffness = w * w * mass;
    gains.damping = 2.0 * k_damping_ratio * w * mass;
    return gains;
}

Mat3 combined_mass(const Mat3& grip_mobility, const Mat3& device_mass) {
    // S = M (1 + Lambda^-1 M)^-1: no inverse of a singular matrix is taken
    const Mat3 one_plus = Mat3::Identity() + grip_mobility * device_mass;
    return device_mass * one_plus.inverse();
}

} // namespace haptics
