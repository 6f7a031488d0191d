#pragma once
/// Inside of collision.cpp: the problem seen through its impulses, and the solvers of one phase. Impulses and
/// velocities are scaled per contact so that every normal has effective mass 1, and by one speed so that no
/// velocity exceeds 1.

#include <haptics/core/contact/collision.hpp>

namespace haptics::detail {

/// Velocities below this count as zero (scaled: the fastest contact has 1).
inline constexpr double k_still = 1e-12;

/// A normal whose part independent of the active ones is below this share of its square counts as dependent.
inline constexpr double k_dependent = 1e-14;
/// Between moving walls, impulses above this mean a jam (scaled: the fastest contact alone would take 1).
inline constexpr double k_jammed = 1e3;

/// The contacts through J D^-1 J^T. Rows 0..contacts-1 are normals, the rest tangents of contacts with
/// friction.
struct ImpulseSpace {
    int contacts{0};
    int rows{0};
    /// rows x rows, row by row.
    const double* delassus{nullptr};
    /// What it is made of: freedoms x freedoms, rows x freedoms.
    int freedoms{0};
    const double* inverse_mass{nullptr};
    const double* jacobian{nullptr};
    /// contacts x freedoms: the normals times the Cholesky factor of the inverse mass; filled in when first
    /// needed.
    const double* whitened{nullptr};
    /// Walls at rest always leave a motion that satisfies all contacts; moving ones may not.
    bool walls_move{false};
    /// Row of the contact's tangent, -1 without friction.
    int tangent_row[k_max_collision_contacts];
    double friction[k_max_collision_contacts];
    /// Contacts to leave without impulse: rows that cannot be moved, squeezed contacts.
    bool excluded[k_max_collision_contacts];

    [[nodiscard]] const double* row(int i) const { return delassus + i * rows; }
    [[nodiscard]] const double* whitened_row(int i) const { return whitened + i * freedoms; }
};

/// Counters that all phases add to.
struct SolverReport {
    int iterations{0};
    int squeezed{0};
    bool fell_back{false};
    /// Multiplications that Lemke's method may still spend in this call: what bounds its time.
    int pivot_work{1'000'000};
};

/// Projection onto opening normals in the metric of D: the impulses 0 <= p (contacts) with v + G p >= 0, p (v
/// + G p) = 0 for the normal velocities v. Contacts that cannot be satisfied become excluded and count as
/// squeezed. When the bound on iterations is reached, p is still >= 0 and still takes energy, but some
/// contacts may still close.
void project_normals(ImpulseSpace& space, const double* velocity, double* impulse,
                     CollisionWorkspace& workspace, SolverReport& report) noexcept;

/// Lower Cholesky factor of a symmetric matrix, n x n row by row; columns without a positive pivot become
/// zero.
void factorize(const double* matrix, int n, double* l) noexcept;

/// One phase with Coulomb friction: normal increments z >= 0 (rows 0..contacts-1) and tangential impulses
/// (tangent rows) with |p_t| <= friction (base + z), z complementary to the normal velocity after, p_t
/// against the slip after. `velocity` (rows) already holds the effect of `base` (contacts).
void solve_with_friction(ImpulseSpace& space, const double* velocity, const double* base, double* impulse,
                         CollisionWorkspace& workspace, SolverReport& report) noexcept;

/// Lemke's method on w = M z + q, w >= 0, z >= 0, w z = 0. `values` is n x (n + 2): M on entry in the
/// first columns, q in the last. `z` (n) is the answer. False when none was found within the bound on
/// work.
bool solve_complementarity(double* values, int n, double* z, SolverReport& report) noexcept;

/// Smallest p with rows rows^T p = target in the sense of least squares, singular values below 1e-9 of the
/// largest left out; `rows` (count x width, row by row) is destroyed, `vectors` is count x count scratch.
/// One-sided Jacobi.
void pseudo_solve(double* rows, int count, int width, double* vectors, const double* target, double* p,
                  int& iterations) noexcept;

/// The two methods kept for comparison.
void resolve_for_comparison(CollisionMethod method, const CollisionProblem& problem,
                            CollisionWorkspace& workspace, CollisionSolution& solution) noexcept;

} // namespace haptics::detail
