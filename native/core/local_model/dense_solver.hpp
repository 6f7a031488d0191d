#pragma once
// The (sub-)step with a dense matrix of any size (primal_solver.hpp).

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

// Velocities and forces at the end of the sub-step; false when the sets did not settle.
bool solve_dense(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                 Integrator integrator);

} // namespace haptics::local
