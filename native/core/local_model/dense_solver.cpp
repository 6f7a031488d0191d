// The (sub-)step of a system of any number of freedoms; apart from the small ones because it takes long to
// compile.

#include "dense_solver.hpp"

#include "primal_solver.hpp"

namespace haptics::local {

bool solve_dense(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                 Integrator integrator) {
    need_mass(model, data);
    PrimalSolver<Eigen::Dynamic> solver(model, data, hand, dt, left);
    return solver.run(integrator);
}

} // namespace haptics::local
