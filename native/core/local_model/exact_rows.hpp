#pragma once
// Rows of the exact integrator where bodies turn: found again within a step, taken halfway, checked at the
// end. For rigid tools (derivation in exact_rows.cpp).

#include <haptics/core/local_model/local_model.hpp>

#include <array>

#include "exact.hpp"

namespace haptics::local {

// Rows of a stretch with what is known of them, to come back to.
class StretchRows {
  public:
    // Rows that fit here and in the exact integrator.
    static bool fits(const ContactSystem& s);

    explicit StretchRows(const ContactSystem& s);
    void restore(ContactSystem& s) const;

    int freedoms;
    int points;
    int patches;
    std::array<PointRow, k_max_exact_points> point;
    std::array<PatchRow, k_max_exact_patches> row;
    std::array<double, static_cast<std::size_t>(k_max_exact_points) * k_flow_freedoms> normal;
    std::array<double, static_cast<std::size_t>(k_max_exact_patches) * k_flow_freedoms> tangent;
};

// The step goes on from the present poses with contacts found again; `left` is what is left of it, s.
void refresh_rows(const Model& model, Data& data, double left);

// Takes the rows of the place halfway along a stretch that began here with the rows `start` and moved by
// `motion`; gaps and all else are those of its start. Returns the energy of contact springs that the other
// shares of points there make, J.
double turn_rows_halfway(const Model& model, Data& data, const StretchRows& start, const ExactMotion& motion);

// Energy of contact springs at the end of a stretch that its rows did not see, J: gaps that changed otherwise
// than the rows say, and overlaps with what no row watched.
double unseen_energy(const Model& model, Data& data, const ExactMotion& motion);

// Energy of overlaps at the start of a step that the last step did not end with, J (data.previous and
// data.patches); `earned` becomes the energy of those that it did end with.
double unearned_energy(const Data& data, double dt, double& earned);

} // namespace haptics::local
