#pragma once
/// Where the proxy alone is stable against a wall: two small experiments per point, judged by energy and
/// residual motion.

#include <haptics/core/local_model/model.hpp>

#include <string_view>

namespace haptics::sweep {

enum class Verdict { stable, chattering, unstable };
[[nodiscard]] std::string_view name_of(Verdict verdict);

struct StabilityPoint {
    Integrator integrator{Integrator::linearly_implicit};
    /// N/m, N s/m, Hz, kg.
    double stiffness{15000.0};
    double damping{20.0};
    double rate{500.0};
    double mass{0.3}; /// True: semi_implicit gives way where it is unstable, as in a scene; false: the method
                      /// itself is judged.
    bool gives_way{false};
};

struct StabilityFigures {
    /// A tool that rests on the wall under 2 N is disturbed by a tenth of what would lift it: largest energy
    /// of the disturbance over that at the start, of the whole run and of its last quarter.
    double growth{0.0};
    double residual{0.0};
    /// A tool is thrown at the wall: energy that comes back over that before, largest over the phases of the
    /// step.
    double bounce{0.0};
    Verdict verdict{Verdict::stable};
};

/// Runs both. Allocates.
[[nodiscard]] StabilityFigures judge(const StabilityPoint& point);

/// The rule: unstable when the disturbance grows (residual above k_grown) or anything is not finite;
/// chattering when it neither grows nor stays below where it began, or when a bounce returns more than 1 %
/// more energy than it brought.
[[nodiscard]] Verdict classify(double growth, double residual, double bounce);
inline constexpr double k_grown = 10.0;
inline constexpr double k_allowed = 1.01;

/// Mass below which semi-implicit stepping of one contact is unstable, kg: (K T^2 + 2 B T) / 4, the bound of
/// the linear analysis.
[[nodiscard]] double semi_implicit_floor(double stiffness, double damping, double step);

} // namespace haptics::sweep
