#pragma once
/// Joint limits and joint friction as rows for a contact solver, as an alternative to the smooth forces of
/// joint_forces.hpp.

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// A unilateral row sign * q'[freedom] >= 0 (solver: impulse >= 0 along `sign`).
struct LimitRow {
    int freedom{0};
    /// +1 at the lower limit, -1 at the upper one.
    double sign{1.0};
    /// Distance to the limit, rad or m; negative when beyond it.
    double gap{0.0};
};

/// A bounded row on q'[freedom] (solver: |force| <= bound).
struct FrictionRow {
    int freedom{0};
    /// Coulomb friction, N m or N.
    double bound{0.0};
};

/// Fixed-capacity lists; a joint has at most one active limit.
struct LimitRows {
    int count{0};
    Slots<LimitRow, k_max_freedoms> row;
};
struct FrictionRows {
    int count{0};
    Slots<FrictionRow, k_max_freedoms> row;
};

/// Lists the limits nearer than `margin` (rad or m).
void limit_rows(const LinkageModel& model, const LinkageData& data, double margin, LimitRows& rows);
/// Lists the joints with friction.
void friction_rows(const LinkageModel& model, FrictionRows& rows);

} // namespace haptics
