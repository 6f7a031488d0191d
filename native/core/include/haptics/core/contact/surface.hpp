#pragma once
/// What a touched surface feels like, and the one rule that combines two of them.

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

/// Contact law of one surface (eq. 8 of Constantinescu, Salcudean and Croft 2003, plus Coulomb friction).
struct Surface {
    /// Normal stiffness K_c of one contact patch, N/m, >= 0.
    double stiffness{15000.0};
    /// Normal damping B_c of one contact patch, N s/m, >= 0.
    double damping{20.0};
    /// Coulomb coefficient while sticking, >= dynamic_friction.
    double static_friction{0.0};
    /// Coulomb coefficient while sliding, >= 0.
    double dynamic_friction{0.0};
    /// Poisson's coefficient of restitution, 0 (dead) to 1 (lossless).
    double restitution{0.0};

    /// Equal in every value: only then two pieces of matter are one to a patch.
    friend bool operator==(const Surface&, const Surface&) = default;
};

/// The surface that leaves every partner's law as it is: that of a tool whose surface nobody set.
inline Surface neutral_surface() {
    constexpr double k_infinite = std::numeric_limits<double>::infinity();
    return {k_infinite, k_infinite, k_infinite, k_infinite, 0.0};
}

/// Two springs that press on each other act in series, so their compliances add; dampers likewise. The
/// smoother side decides the friction, the livelier one the restitution. So infinite stiffness, damping and
/// friction with restitution 0 leave the partner's law as it is.
inline Surface combine(const Surface& a, const Surface& b) {
    const auto series = [](double p, double q) {
        if (std::isinf(p))
            return q;
        if (std::isinf(q))
            return p;
        return p + q > 0.0 ? p * q / (p + q) : 0.0;
    };
    return {series(a.stiffness, b.stiffness), series(a.damping, b.damping),
            std::min(a.static_friction, b.static_friction), std::min(a.dynamic_friction, b.dynamic_friction),
            std::max(a.restitution, b.restitution)};
}

} // namespace haptics
