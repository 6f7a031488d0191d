#pragma once
/// Energy and momentum of a linkage: the ledgers of the tests. After update_positions().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// Linear momentum (N s) and angular momentum about the scene's origin (N m s).
struct Momentum {
    Vec2 linear{0.0, 0.0};
    double angular{0.0};
};

/// Kinetic energy, J.
[[nodiscard]] double kinetic_energy(const LinkageModel& model, const LinkageData& data);
/// Energy of gravity (zero at the scene's origin), joint springs and limit springs, J.
[[nodiscard]] double potential_energy(const LinkageModel& model, const LinkageData& data);
/// Total momentum of all bodies.
[[nodiscard]] Momentum total_momentum(const LinkageModel& model, const LinkageData& data);

} // namespace haptics
