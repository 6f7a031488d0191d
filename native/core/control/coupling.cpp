// Gains of the coupling.
//
// Worst case for the spring between handle and proxy is a proxy that stands still (a hard wall): the device's
// mass m alone moves on K, B through a loop that samples (the force is held for a step: T/2 on average),
// computes (one step: T) and takes velocity from differences over n samples (n T/2): tau = (3 + n) T/2 plus
// the device's own delay. With L(s) = (B s + K) e^(-s tau) / (m s^2), K = m w^2 and B = 2 z m w, the gain
// crosses one at w_c = w sqrt(2 z^2 + sqrt(4 z^4 + 1)), that is 1.55 w for z = 0.7, where the phase margin is
// atan(2 z w_c / w) - w_c tau = 65 deg - 1.55 w tau. Asking for 39 deg leaves w tau = 0.29.
// With four channels the wall's answer to the coupling comes back a second time, fed forward with the weight
// a = S J_h D^-1 J_h^T (between 0 for a heavy and 1 for a light proxy), so the loop's gain is 1 + a times
// that of the spring: K = m (0.29 / tau)^2 / (1 + a), and B likewise. For 0.3 kg on both sides at 500 Hz and
// n = 2 this is 673 N/m and 16.2 N s/m.
//
// An encoder's step q is a velocity of q / (n T) over n samples, and a force of B q / (n T): 1.2 N at 2 kHz
// with 25 um and n = 2. Such steps, late by tau, also pump energy into the hand (up to 0.15 J in 10 s of
// leaning, velocity_window_test.cpp). A longer window makes them smaller, by more than 1/n, for B falls as
// well; so n is the shortest with which they stay within twice the deviation that is allowed. The estimator
// is adaptive: it takes all of the window only while the motion in it is straight within an encoder step, so
// what moves by more than that lags by less, and half of the window is provided for. What moves by less meets
// the coupling late, but with K q at most.
//
// Truncated inverse. With M_d = L L^T the mobility P becomes A = L^T P L, whose eigenvalues are the ratios of
// the device's mass to the proxy's, whatever the units of the three freedoms; P^-1 = L A^-1 L^T. An
// eigenvalue below k_heavy has no inverse, one above 2 k_heavy has its own, and 3 u^2 - 2 u^3 leads from one
// to the other, so the result is continuous in the pose and at most 1 / k_heavy times M_d.
//
// S form. Device M_d a = F_h + L and proxy D q'' = tau - J_h^T L share the grip, J_h q'' = a, so L = S (J_h
// D^-1 tau - M_d^-1 F_h) with S = (J_h D^-1 J_h^T + M_d^-1)^-1. The device is fed forward S J_h D^-1 tau, the
// proxy S J_h D^-1 J_h^T F_h (note 1 - S M_d^-1 = S J_h D^-1 J_h^T). At rest the sum of both equations says
// (1 + S J_h D^-1 J_h^T)(F_h + F_env) = 0: a steady push gives the push back, whatever the masses.
//
// Energy of the force channels. F_h fed to the proxy with the weight A = S P (P = J_h D^-1 J_h^T) and tau to
// the device with A do the work v.A (F_h + tau) beyond that of the coupling, which gives to one what it takes
// from the other. Device M_d a_d = F_h - c + A tau and proxy P^-1 a_p = tau + c + A F_h together are M_d a_d
// + P^-1 a_p = (1 + A)(F_h + tau), so that the work is v.A (1 + A)^-1 (M_d a_d + P^-1 a_p): it moves the
// inertia A (1
// + A)^-1 M_d of the device and A (1 + A)^-1 P^-1 of the proxy, which the hand does not feel, and comes back
// when they stop. With X = M_d P that is X (1 + 2 X)^-1 M_d and (1 + 2 X)^-1 M_d: P is not inverted. When
// only the share s of the forces takes effect, A becomes s A, and 1 + 2 X becomes (1 + (1 + s) X) / s.
// Likewise beside acceleration feed-forward (shared_motion.cpp), whose u + L = (M_d - M') a* moves the pair
// by a*, with (M_d + P^-1) a* = M_d a_d + P^-1 a_p. Where the hand's force is measured, friction phi of the
// device, M_d a_d = F_h - c + A tau - phi, is passed on as well: v.A (1 + A)^-1 phi.

#include <haptics/core/control/coupling.hpp>

#include <algorithm>

namespace haptics {

CouplingGains default_gains(const Mat3& device_mass, const Mat3& mobility, double period, double delay,
                            int velocity_window) {
    constexpr double k_frequency = 0.29; // w tau
    constexpr double k_damping_ratio = 0.7;
    const double w = k_frequency / (0.5 * (3.0 + velocity_window) * period + std::max(delay, 0.0));
    const double lightest = lightest_mass(device_mass);
    const double most_mobile = std::max(mobility(0, 0), mobility(1, 1));
    // a = m_d / (m_d + m_p), written with 1/m_p so that a proxy that cannot move gives 0
    const auto share = [](double mass, double inverse) { return mass * inverse / (1.0 + mass * inverse); };
    const Vec3 mass(lightest, lightest, device_mass(2, 2));
    const double translation = 1.0 + share(lightest, most_mobile);
    const Vec3 loop_gain(translation, translation, 1.0 + share(device_mass(2, 2), mobility(2, 2)));
    CouplingGains gains;
    gains.stiffness = w * w * mass.cwiseQuotient(loop_gain);
    gains.damping = 2.0 * k_damping_ratio * w * mass.cwiseQuotient(loop_gain);
    return gains;
}

VelocityWindow choose_velocity_window(const Mat3& device_mass, const Mat3& mobility, double period,
                                      double delay, const Vec3& encoder_step, double noise,
                                      double noise_torque) {
    constexpr int k_longest = 63;
    const Vec3 allowed = 2.0 * Vec3(noise, noise, noise_torque);
    VelocityWindow window;
    for (; window.longest < k_longest; ++window.longest) {
        window.lag = std::max(2, (window.longest + 1) / 2);
        const Vec3 damping = default_gains(device_mass, mobility, period, delay, window.lag).damping;
        const Vec3 jump = damping.cwiseProduct(encoder_step) / (window.longest * period);
        if ((jump.array() <= allowed.array()).all())
            break;
    }
    return window;
}

double lightest_mass(const Mat3& device_mass) {
    const double xx = device_mass(0, 0);
    const double yy = device_mass(1, 1);
    const double xy = device_mass(0, 1);
    return 0.5 * (xx + yy) - std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
}

Mat3 combined_mass(const Mat3& grip_mobility, const Mat3& device_mass) {
    // S = M (1 + Lambda^-1 M)^-1: no inverse of a singular matrix is taken
    const Mat3 one_plus = Mat3::Identity() + grip_mobility * device_mass;
    return device_mass * one_plus.inverse();
}

LentMass lent_mass(const Mat3& grip_mobility, const Mat3& device_mass, double share) {
    const Mat3 ratio = device_mass * grip_mobility;
    const Mat3 part = share * (Mat3::Identity() + (1.0 + share) * ratio).inverse();
    return {part * ratio * device_mass, part * device_mass, part * ratio};
}

LentMass lent_mass_hidden(const Mat3& grip_mobility, const Mat3& device_mass, const Mat3& hidden) {
    const Mat3 ratio = grip_mobility * device_mass;
    const Mat3 part = hidden * (Mat3::Identity() + ratio).inverse();
    return {part * ratio, part, part * grip_mobility};
}

Mat3 truncated_mass(const Mat3& grip_mobility, const Mat3& device_mass) {
    constexpr double k_heavy = 0.02;
    const Mat3 root = device_mass.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Mat3> ratios(root.transpose() * grip_mobility * root);
    Vec3 inverse;
    for (int i = 0; i < 3; ++i) {
        const double a = ratios.eigenvalues()(i);
        const double u = std::clamp((a - k_heavy) / k_heavy, 0.0, 1.0);
        inverse(i) = u > 0.0 ? u * u * (3.0 - 2.0 * u) / a : 0.0;
    }
    const Mat3 axes = root * ratios.eigenvectors();
    return axes * inverse.asDiagonal() * axes.transpose();
}

} // namespace haptics
