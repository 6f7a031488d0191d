#include <haptics/core/dynamics/dense_dynamics.hpp>

namespace haptics {

void dense_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                        const LinkageVector* added, DenseDynamics& dense, LinkageVector& acceleration) {
    mass_matrix(model, data, dense.mass);
    bias_forces(model, data, dense.bias);
    if (added != nullptr) {
        dense.mass.diagonal() += *added;
    }
    dense.factor.compute(dense.mass);
    acceleration = force - dense.bias;
    dense.factor.solveInPlace(acceleration);
}

} // namespace haptics
