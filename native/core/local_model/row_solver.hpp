#pragma once
// The (sub-)step of a long linkage, with its rows as unknowns (row_solver.cpp).

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

inline bool is_long(const Model& model) {
    return model.tool.articulated && model.tool.linkage.freedoms > model.settings.dense_freedoms;
}

// The rows of the system and of the grip are few enough.
inline bool fits_row_solver(const ContactSystem& s) {
    return s.points + s.patches + 3 <= k_most_solver_rows;
}

// Velocities and forces at the end of the sub-step; false when the sets did not settle.
bool solve_by_rows(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                   Integrator integrator);

} // namespace haptics::local
