/// One phase of a collision with Coulomb friction.
///
/// Find normal increments z and tangential impulses t with
///     0 <= z, 0 <= v_n', z v_n' = 0,     |t| <= mu (h + z), t against the slip v_t' (of full size where v_t'
///     is not zero)
/// where v' = v + G (z, t) are the velocities after, and h >= 0 normal impulses that act anyway (the
/// restitution). Every solution takes energy: its change is p v' - p G p / 2 with p v' = z v_n' + t v_t' <=
/// 0.
///
/// In the plane the cone of friction has two edges, so this is exactly a linear complementarity problem
/// (Stewart and Trinkle 1996) in z, b+ and b- (t = b+ - b-) and the slip speed l:
///     v_n' = v_n + G_nn z + G_nt t     with z
///     l + v_t'                         with b+
///     l - v_t'                         with b-
///     mu (h + z) - b+ - b-             with l
/// Its matrix is copositive: u^T M u = p G p + mu l z >= 0 for u >= 0. Lemke's method therefore ends with a
/// solution whenever u >= 0, M u >= 0, u^T M u = 0 imply u^T q >= 0 (Cottle, Pang and Stone, theorem 4.4.13).
/// With v = J x (walls at rest, or a motion x that keeps up with them) u^T M u = 0 makes J^T p = 0, hence u^T
/// q = p J x + mu l h >= 0: a solution exists. One contact is solved case by case.
///
/// Fallback: sweeps over the contacts; a closing one gets the single-contact impulse that stops it. Each such
/// hit keeps its own cone and takes energy, and sums of impulses in a cone stay in the cone. A last
/// projection of the normals ends what still closes.

#include <cmath>

#include "collision_solver.hpp"

namespace haptics::detail {
namespace {

constexpr int k_sweeps = 8;
constexpr double k_tolerated_closing = 1e-11;
/// Share of the largest impulse by which an answer may miss its conditions.
constexpr double k_residual = 1e-9;
/// Scaled compliances of the attempts: they make G positive definite, so that a solution exists even between
/// walls.
constexpr double k_compliance[] = {0.0, 1e-12, 1e-9};
/// What k_jammed is for exact solutions, for a single hit of the fallback.
constexpr double k_runaway = 10.0;

struct ContactImpulse {
    double normal{0.0};
    double tangent{0.0};
};

double clamp(double value, double limit) {
    return std::fmax(-limit, std::fmin(limit, value));
}

/// The problem above for one contact, case by case.
ContactImpulse solve_one(double nn, double nt, double tt, double vn, double vt, double mu, double h) {
    // opens without further normal impulse
    const double drag = tt > 0.0 ? clamp(-vt / tt, mu * h) : 0.0;
    if (vn + nt * drag >= 0.0)
        return {0.0, drag};
    // sticks
    const double det = nn * tt - nt * nt;
    if (det > 1e-12 * nn * tt) {
        const double z = (nt * vt - tt * vn) / det;
        const double t = (nt * vn - nn * vt) / det;
        if (z >= 0.0 && std::fabs(t) <= mu * (h + z))
            return {z, t};
    }
    // slides on in the direction it had, or turns round
    double direction = vt < 0.0 ? -1.0 : 1.0;
    for (int attempt = 0; attempt < 2; ++attempt, direction = -direction) {
        const double slope = nn - direction * mu * nt;
        if (slope <= 1e-9 * nn)
            continue;
        const double z = (direction * mu * nt * h - vn) / slope;
        const double t = -direction * mu * (h + z);
        if (z >= 0.0 && direction * (vt + nt * z + tt * t) >= -k_still)
            return {z, t};
    }
    return {std::fmax(0.0, -vn / nn), 0.0};
}

void add_column(const ImpulseSpace& space, int row, double impulse, double* v) {
    if (impulse == 0.0)
        return;
    const double* column = space.row(row);
    for (int i = 0; i < space.rows; ++i)
        v[i] += column[i] * impulse;
}

ContactImpulse solve_one(const ImpulseSpace& space, int i, const double* v, double h) {
    const int t = space.tangent_row[i];
    if (t < 0)
        return {std::fmax(0.0, -v[i] / space.row(i)[i]), 0.0};
    return solve_one(space.row(i)[i], space.row(i)[t], space.row(t)[t], v[i], v[t], space.friction[i], h);
}

/// Builds and solves the complementarity problem of the chosen contacts; `after` (rows) are the velocities
/// then.
bool solve_chosen(const ImpulseSpace& space, const int* chosen, int count, const double* velocity,
                  const double* base, double compliance, double* impulse, double* after,
                  CollisionWorkspace& workspace, SolverReport& report) {
    // a place in the tableau stands for +-1 times a row of the impulse space, or for a slip speed
    int row_of[CollisionWorkspace::k_complementarity];
    double sign_of[CollisionWorkspace::k_complementarity];
    int size = 0;
    const auto place = [&](int row, double sign) {
        row_of[size] = row;
        sign_of[size++] = sign;
    };
    for (int k = 0; k < count; ++k) {
        place(chosen[k], 1.0);
        if (const int t = space.tangent_row[chosen[k]]; t >= 0) {
            place(t, 1.0);
            place(t, -1.0);
            place(-1, 0.0);
        }
    }
    double* tableau = workspace.tableau;
    const int width = size + 2;
    for (int i = 0; i < size; ++i) {
        double* line = tableau + i * width;
        if (row_of[i] < 0) {
            for (int j = 0; j < width; ++j)
                line[j] = 0.0;
            continue;
        }
        const double* g = space.row(row_of[i]);
        for (int j = 0; j < size; ++j)
            line[j] = row_of[j] < 0 ? 0.0
                                    : sign_of[i] * sign_of[j] *
                                          (g[row_of[j]] + (row_of[i] == row_of[j] ? compliance : 0.0));
        line[size + 1] = sign_of[i] * velocity[row_of[i]];
    }
    for (int k = 0, i = 0; k < count; ++k) {
        const int contact = chosen[k];
        if (space.tangent_row[contact] < 0) {
            ++i;
            continue;
        }
        tableau[(i + 1) * width + i + 3] = 1.0;
        tableau[(i + 2) * width + i + 3] = 1.0;
        double* cone = tableau + (i + 3) * width;
        cone[i] = space.friction[contact];
        cone[i + 1] = -1.0;
        cone[i + 2] = -1.0;
        cone[size + 1] = space.friction[contact] * base[contact];
        i += 4;
    }
    double z[CollisionWorkspace::k_complementarity];
    if (!solve_complementarity(tableau, size, z, report))
        return false;
    for (int i = 0; i < space.rows; ++i)
        impulse[i] = 0.0;
    double largest = 0.0;
    for (int i = 0; i < size; ++i) {
        if (row_of[i] < 0)
            continue;
        impulse[row_of[i]] += sign_of[i] * z[i];
        largest = std::fmax(largest, z[i]);
    }
    if (space.walls_move && largest > k_jammed)
        return false;
    for (int i = 0; i < space.rows; ++i)
        after[i] = velocity[i];
    for (int i = 0; i < space.rows; ++i)
        add_column(space, i, impulse[i], after);
    // many pivots on dependent rows can go wrong by rounding: look at the answer
    const double tolerance = k_residual * (1.0 + largest);
    for (int k = 0; k < count; ++k) {
        const int i = chosen[k];
        if (!(after[i] >= -tolerance) || impulse[i] * after[i] > tolerance)
            return false;
        if (const int t = space.tangent_row[i]; t >= 0) {
            const double limit = space.friction[i] * (base[i] + impulse[i]);
            if (!(std::fabs(impulse[t]) <= limit + tolerance) ||
                impulse[t] * after[t] + limit * std::fabs(after[t]) > tolerance)
                return false;
        }
    }
    return true;
}

/// Solves for the contacts that close or carry base impulses, and again with those that start to close
/// thereby.
bool solve_exactly(const ImpulseSpace& space, const double* velocity, const double* base, double* impulse,
                   CollisionWorkspace& workspace, SolverReport& report) {
    const int m = space.contacts;
    bool is_chosen[k_max_collision_contacts];
    for (int i = 0; i < m; ++i)
        is_chosen[i] = !space.excluded[i] && (velocity[i] < 1e-9 || base[i] > 0.0);
    for (int round = 0; round < 4; ++round) {
        int chosen[k_max_collision_contacts];
        int count = 0;
        int with_friction = 0;
        for (int i = 0; i < m; ++i) {
            is_chosen[i] = is_chosen[i] || (round == 3 && !space.excluded[i]);
            if (is_chosen[i]) {
                chosen[count++] = i;
                with_friction += space.tangent_row[i] >= 0 ? 1 : 0;
            }
        }
        if (with_friction > k_max_exact_friction_contacts)
            return false;
        double v[CollisionWorkspace::k_rows];
        if (count == 1) {
            const int only = chosen[0];
            const ContactImpulse one = solve_one(space, only, velocity, base[only]);
            for (int i = 0; i < space.rows; ++i) {
                impulse[i] = 0.0;
                v[i] = velocity[i];
            }
            impulse[only] = one.normal;
            add_column(space, only, one.normal, v);
            if (const int t = space.tangent_row[only]; t >= 0) {
                impulse[t] = one.tangent;
                add_column(space, t, one.tangent, v);
            }
            ++report.iterations;
        } else {
            bool solved = false;
            for (const double compliance : k_compliance)
                solved = solved || solve_chosen(space, chosen, count, velocity, base, compliance, impulse, v,
                                                workspace, report);
            if (!solved)
                return false;
        }
        bool complete = true;
        for (int i = 0; i < m; ++i) {
            if (!is_chosen[i] && !space.excluded[i] && v[i] < -k_tolerated_closing) {
                is_chosen[i] = true;
                complete = false;
            }
        }
        if (complete)
            return true;
    }
    return true;
}

/// The fallback: sweeps of single hits. False in a jam between moving walls, where each hit makes the next
/// one harder.
bool solve_by_sweeps(const ImpulseSpace& space, const double* velocity, const double* base, double* impulse,
                     SolverReport& report) {
    double v[CollisionWorkspace::k_rows];
    for (int i = 0; i < space.rows; ++i) {
        v[i] = velocity[i];
        impulse[i] = 0.0;
    }
    for (int i = 0; i < space.contacts; ++i) {
        const int t = space.tangent_row[i];
        if (t < 0 || base[i] <= 0.0 || space.row(t)[t] <= 0.0)
            continue;
        impulse[t] = clamp(-v[t] / space.row(t)[t], space.friction[i] * base[i]);
        add_column(space, t, impulse[t], v);
    }
    for (int sweep = 0; sweep < k_sweeps; ++sweep) {
        ++report.iterations;
        for (int i = 0; i < space.contacts; ++i) {
            if (space.excluded[i] || v[i] >= -k_still)
                continue;
            const ContactImpulse hit = solve_one(space, i, v, 0.0);
            impulse[i] += hit.normal;
            add_column(space, i, hit.normal, v);
            if (const int t = space.tangent_row[i]; t >= 0) {
                impulse[t] += hit.tangent;
                add_column(space, t, hit.tangent, v);
            }
            if (space.walls_move && hit.normal > k_runaway)
                return false;
        }
    }
    return true;
}

} // namespace

void solve_with_friction(ImpulseSpace& space, const double* velocity, const double* base, double* impulse,
                         CollisionWorkspace& workspace, SolverReport& report) noexcept {
    if (!solve_exactly(space, velocity, base, impulse, workspace, report)) {
        report.fell_back = true;
        if (!solve_by_sweeps(space, velocity, base, impulse, report))
            for (int i = 0; i < space.rows; ++i)
                impulse[i] = 0.0; // without friction: the projection below does it all
    }

    // hold the cone exactly, whatever the rounding, and end what still closes
    double v[CollisionWorkspace::k_rows];
    for (int i = 0; i < space.rows; ++i)
        v[i] = velocity[i];
    bool closing = false;
    for (int i = 0; i < space.contacts; ++i) {
        add_column(space, i, impulse[i], v);
        if (const int t = space.tangent_row[i]; t >= 0) {
            impulse[t] = clamp(impulse[t], space.friction[i] * (base[i] + impulse[i]));
            add_column(space, t, impulse[t], v);
        }
    }
    for (int i = 0; i < space.contacts; ++i)
        closing = closing || (!space.excluded[i] && v[i] < -k_tolerated_closing);
    if (!closing)
        return;
    double more[k_max_collision_contacts];
    project_normals(space, v, more, workspace, report);
    for (int i = 0; i < space.contacts; ++i)
        impulse[i] += more[i];
}

} // namespace haptics::detail
