#pragma once
/// Forward dynamics by the dense mass matrix and Eigen's LDLT: O(n^3), the truth against which the fast
/// methods are tested.

#include <haptics/core/dynamics/mass_matrix.hpp>

namespace haptics {

/// Memory of the dense method.
struct DenseDynamics {
    LinkageMatrix mass;
    LinkageVector bias;
    Eigen::LDLT<LinkageMatrix> factor;
};

/// acceleration = D^-1 (force - C - G). `added` (may be null) is added to the diagonal of D. After
/// update_positions().
void dense_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                        const LinkageVector* added, DenseDynamics& dense, LinkageVector& acceleration);

} // namespace haptics
