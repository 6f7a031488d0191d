#pragma once
/// Forward dynamics by the dense mass matrix and Eigen's LDLT: O(n^3), the truth against which the fast
/// methods are tested.

#include <haptics/core/dynamics/mass_matrix.hpp>

namespace haptics {

/// Memory of the dense method.
struct DenseDynamics {
    JointMatrix mass;
    JointVector bias;
    Eigen::LDLT<JointMatrix> factor;
};

/// acceleration = D^-1 (force - C - G). `added` (may be null) is added to the diagonal of D. After
/// update_positions().
void dense_acceleration(const LinkageModel& model, const LinkageData& data, const JointVector& force,
                        const JointVector* added, DenseDynamics& dense, JointVector& acceleration);

} // namespace haptics
