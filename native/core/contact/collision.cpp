/// Simultaneous collisions by Poisson's hypothesis.
///
/// Contact i opens at v_n = J_n q' - w_n and slips at v_t = J_t q' - w_t (w: walls). Impulses p = (p_n, p_t)
/// change the motion by D^-1 J^T p and the contact velocities by G p, G = J D^-1 J^T. The energy they add,
/// less the work p w of moving walls, is
///     E(p) = p v- + p G p / 2 = p (v- + v+) / 2.
/// With walls at rest this is the change of kinetic energy. If all walls move as one (J u = w for a motion u
/// of the tool that keeps up with them) it is the change of kinetic energy in the walls' frame. If walls move
/// differently there is no such frame, and E <= 0 says that the tool gains no more than the walls do work on
/// it: walls and tool together, the walls as infinitely heavy bodies, gain nothing.
///
/// Compression: 0 <= p_n, 0 <= v_n, p_n v_n = 0 and Coulomb friction, p_t against the slip after. Without
/// friction this is the projection of q' onto {J_n x >= w_n} in the D-norm (collision_projection.cpp); with
/// friction see collision_friction.cpp. It exists wherever some motion opens all contacts (walls at rest: x =
/// 0 does), and
///     E(p1) = p1 v1 - p1 G p1 / 2 <= 0, because p_n v_n = 0 and p_t v_t <= 0.
/// Contacts squeezed between walls so that no motion opens them get no impulse and are counted.
///
/// Restitution: the impulses h = e p_n1 come back, and the same problem is solved once more from v1 with h
/// given: v2 has v_n >= 0, p2 = (h + z, t) with z >= 0 and |t| <= mu (h + z). The impulses p1 + s p2, 0 <= s
/// <= 1, lead to (1 - s) v1 + s v2: for every s no impulse pulls, no contact closes, all cones hold. The
/// energy
///     E(p1 + s p2) = E(p1) + s p2 v1 + s^2 p2 G p2 / 2
/// is convex in s and E(p1) <= 0 at s = 0, so a largest s in 0..1 with E <= 0 exists and is the root of a
/// quadratic. Where without friction all e are equal, s = 1: p2 = e p1 + (z, 0) is a projection (z) of x1 + e
/// (x1 - x-), whose square is |x1|^2 + e^2 |x1 - x-|^2 <= |x-|^2 in the walls' frame, as x1 is perpendicular
/// to x1 - x-.
///
/// What to expect: one contact without friction leaves at exactly -e times its velocity. With friction the
/// normal *impulse* obeys e (Poisson), the velocity only where normal and tangent are not coupled (G_nt = 0).
/// A chain of touching equal balls hit with e = 1 moves as (-1/3, 2/3, 2/3), not as Newton's cradle (0, 0,
/// 1): both keep energy and momentum, but the cradle is a sequence of hits, this is one. Where normals depend
/// on each other (four corners in a tight pocket) the motion after compression is unique but its split into
/// impulses is not; with unequal restitutions the result then depends on the order of contacts.

#include <algorithm>
#include <cmath>

#include "collision_solver.hpp"

namespace haptics {
namespace {

using detail::ImpulseSpace;
using detail::SolverReport;

/// Square of a row's norm below this share of the largest: the contact cannot be moved.
constexpr double k_immovable = 1e-14;
/// The same against the contact's own tangent, where walls move: they could force any speed on it.
constexpr double k_immovable_by_walls = 1e-6;
/// A row whose entries are all below this (m/rad or m/m) is rounding.
constexpr double k_shortest_lever = 1e-12;
/// Share of its summands below which a velocity is rounding.
constexpr double k_rounding = 1e-15;

double dot(const double* a, const double* b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        sum += a[i] * b[i];
    return sum;
}

/// to = row * inverse_mass (symmetric), n long.
void respond(const CollisionProblem& problem, const double* row, double* to, int n) {
    for (int j = 0; j < n; ++j)
        to[j] = 0.0;
    for (int k = 0; k < n; ++k) {
        const double factor = row[k];
        if (factor == 0.0)
            continue;
        const double* w = problem.inverse_mass.data() + k * n;
        for (int j = 0; j < n; ++j)
            to[j] += factor * w[j];
    }
}

/// The rows of one problem in scaled units.
struct Rows {
    int n{0};
    double* jacobian{nullptr};
    double* response{nullptr};
    double scale[k_max_collision_contacts];
    /// Contact velocities before, scaled by `speed` too.
    double velocity[CollisionWorkspace::k_rows];
    double wall[CollisionWorkspace::k_rows];
    double speed{0.0};

    void take(const CollisionProblem& problem, int row, const double* source, double factor,
              double wall_velocity) {
        double* j = jacobian + row * n;
        for (int k = 0; k < n; ++k)
            j[k] = factor * source[k];
        wall[row] = factor * wall_velocity;
        velocity[row] = -wall[row];
        double size = std::fabs(wall[row]);
        for (int k = 0; k < n; ++k) {
            const double part = j[k] * problem.velocity[k];
            velocity[row] += part;
            size += std::fabs(part);
        }
        if (std::fabs(velocity[row]) <= k_rounding * size)
            velocity[row] = 0.0;
        speed = std::fmax(speed, std::fabs(velocity[row]));
    }
};

/// Normals: responses, scales, velocities. True when some contact closes.
bool take_normals(const CollisionProblem& problem, ImpulseSpace& space, Rows& rows) {
    const int m = space.contacts;
    const int n = rows.n;
    double largest = 0.0;
    for (int i = 0; i < m; ++i) {
        const double* source = problem.normal_rows.data() + i * n;
        respond(problem, source, rows.response + i * n, n);
        rows.scale[i] = dot(source, rows.response + i * n, n);
        double longest = 0.0;
        for (int k = 0; k < n; ++k)
            longest = std::fmax(longest, std::fabs(source[k]));
        space.excluded[i] = !(longest > k_shortest_lever);
        largest = std::fmax(largest, rows.scale[i]);
        space.walls_move = space.walls_move || problem.wall_normal_velocity[i] != 0.0;
    }
    bool closing = false;
    for (int i = 0; i < m; ++i) {
        space.excluded[i] = space.excluded[i] || !(rows.scale[i] > k_immovable * largest);
        if (space.walls_move && !space.excluded[i]) {
            double response[k_max_collision_freedoms];
            const double* tangent = problem.tangent_rows.data() + i * n;
            respond(problem, tangent, response, n);
            space.excluded[i] = rows.scale[i] <= k_immovable_by_walls * dot(tangent, response, n);
        }
        rows.scale[i] = space.excluded[i] ? 0.0 : 1.0 / std::sqrt(rows.scale[i]);
        rows.take(problem, i, problem.normal_rows.data() + i * n, rows.scale[i],
                  problem.wall_normal_velocity[i]);
        for (int k = 0; k < n; ++k)
            rows.response[i * n + k] *= rows.scale[i];
        closing = closing || rows.velocity[i] < 0.0;
    }
    return closing;
}

void take_tangents(const CollisionProblem& problem, ImpulseSpace& space, Rows& rows) {
    const int n = rows.n;
    for (int i = 0; i < space.contacts; ++i) {
        space.tangent_row[i] = -1;
        space.friction[i] = 0.0;
        if (!(problem.friction[i] > 0.0) || space.excluded[i])
            continue;
        const int row = space.rows;
        rows.take(problem, row, problem.tangent_rows.data() + i * n, rows.scale[i],
                  problem.wall_tangent_velocity[i]);
        respond(problem, rows.jacobian + row * n, rows.response + row * n, n);
        // a tangent that cannot be moved feels no friction
        if (dot(rows.jacobian + row * n, rows.response + row * n, n) <= k_immovable)
            continue;
        space.tangent_row[i] = row;
        space.friction[i] = problem.friction[i];
        ++space.rows;
    }
}

void fill_delassus(const ImpulseSpace& space, const Rows& rows, double* delassus) {
    for (int i = 0; i < space.rows; ++i) {
        for (int j = 0; j <= i; ++j) {
            const double g = dot(rows.response + i * rows.n, rows.jacobian + j * rows.n, rows.n);
            delassus[i * space.rows + j] = g;
            delassus[j * space.rows + i] = g;
        }
    }
}

/// Impulses of one phase and what they do: f = J^T p, u = D^-1 f, work = p w.
struct Phase {
    double impulse[CollisionWorkspace::k_rows];
    double force[k_max_collision_freedoms];
    double change[k_max_collision_freedoms];
    double work{0.0};

    /// The change comes from the summed force, not from the rows' responses: large impulses that nearly
    /// cancel (a wedge) would leave force and change apart, and the energies below are as exact as these two
    /// agree.
    void sum(const CollisionProblem& problem, const ImpulseSpace& space, const Rows& rows) {
        for (int k = 0; k < rows.n; ++k)
            force[k] = 0.0;
        work = 0.0;
        for (int i = 0; i < space.rows; ++i) {
            const double p = impulse[i];
            if (p == 0.0)
                continue;
            for (int k = 0; k < rows.n; ++k)
                force[k] += rows.jacobian[i * rows.n + k] * p;
            work += rows.wall[i] * p;
        }
        respond(problem, force, change, rows.n);
    }
    /// Velocities after: before + G p.
    void carry(const ImpulseSpace& space, const double* before, double* after) const {
        for (int i = 0; i < space.rows; ++i)
            after[i] = before[i];
        for (int i = 0; i < space.rows; ++i) {
            if (impulse[i] == 0.0)
                continue;
            const double* column = space.row(i);
            for (int j = 0; j < space.rows; ++j)
                after[j] += column[j] * impulse[i];
        }
    }
};

/// Largest s in 0..1 with start + slope s + curve s^2 <= 0, for start <= 0 and curve >= 0.
double largest_share(double start, double slope, double curve) {
    if (start + slope + curve <= 0.0)
        return 1.0;
    start = std::fmin(start, 0.0);
    const double root = std::sqrt(slope * slope - 4.0 * curve * start);
    const double share = slope > 0.0 ? -2.0 * start / (slope + root) : (root - slope) / (2.0 * curve);
    return std::fmin(1.0, std::fmax(0.0, share));
}

void solve_phase(ImpulseSpace& space, const double* velocity, const double* base, Phase& phase,
                 CollisionWorkspace& workspace, SolverReport& report) {
    if (space.rows == space.contacts)
        detail::project_normals(space, velocity, phase.impulse, workspace, report);
    else
        detail::solve_with_friction(space, velocity, base, phase.impulse, workspace, report);
}

/// One contact without friction, in closed form: p = -(1 + e) v / (J D^-1 J^T).
void resolve_one(const CollisionProblem& problem, CollisionSolution& solution) {
    const int n = problem.freedoms();
    const double* row = problem.normal_rows.data();
    double response[k_max_collision_freedoms];
    respond(problem, row, response, n);
    const double yield = dot(row, response, n);
    const double wall = problem.wall_normal_velocity[0];
    double velocity = -wall;
    double size = std::fabs(wall);
    double longest = 0.0;
    for (int k = 0; k < n; ++k) {
        const double part = row[k] * problem.velocity[k];
        velocity += part;
        size += std::fabs(part);
        longest = std::fmax(longest, std::fabs(row[k]));
    }
    if (!(velocity < -k_rounding * size) || !(longest > k_shortest_lever) || !(yield > 0.0))
        return;
    if (wall != 0.0) {
        double across[k_max_collision_freedoms];
        respond(problem, problem.tangent_rows.data(), across, n);
        if (yield <= k_immovable_by_walls * dot(problem.tangent_rows.data(), across, n))
            return;
    }
    const double e = std::clamp(problem.restitution[0], 0.0, 1.0);
    const double p = -(1.0 + e) * velocity / yield;
    for (int k = 0; k < n; ++k) {
        solution.momentum_change[k] = p * row[k];
        solution.velocity[k] += p * response[k];
    }
    solution.normal_impulse[0] = p;
    // p (v- + v+)/2 with v+ = -e v-
    solution.energy_change = 0.5 * p * (1.0 - e) * velocity;
    solution.iterations = 1;
}

void resolve_by_poisson(const CollisionProblem& problem, CollisionWorkspace& workspace,
                        CollisionSolution& solution) {
    ImpulseSpace space;
    space.contacts = problem.contacts();
    space.rows = space.contacts;
    Rows rows;
    rows.n = problem.freedoms();
    rows.jacobian = workspace.jacobian;
    rows.response = workspace.response;
    if (!take_normals(problem, space, rows))
        return;
    take_tangents(problem, space, rows);
    fill_delassus(space, rows, workspace.delassus);
    space.delassus = workspace.delassus;
    space.freedoms = rows.n;
    space.inverse_mass = problem.inverse_mass.data();
    space.jacobian = rows.jacobian;
    const int m = space.contacts;
    const double to_scaled = 1.0 / rows.speed;
    for (int i = 0; i < space.rows; ++i) {
        rows.velocity[i] *= to_scaled;
        rows.wall[i] *= to_scaled;
    }

    // compression
    SolverReport report;
    double base[k_max_collision_contacts] = {};
    Phase first;
    if (space.walls_move && space.rows > m)
        detail::project_normals(space, rows.velocity, first.impulse, workspace,
                                report); // finds squeezed contacts
    solve_phase(space, rows.velocity, base, first, workspace, report);
    first.sum(problem, space, rows);

    // restitution
    Phase second;
    bool bounces = false;
    for (int i = 0; i < m; ++i) {
        base[i] = std::clamp(problem.restitution[i], 0.0, 1.0) * first.impulse[i];
        bounces = bounces || base[i] > 0.0;
    }
    if (bounces) {
        double after[CollisionWorkspace::k_rows];
        double pushed[CollisionWorkspace::k_rows];
        first.carry(space, rows.velocity, after);
        Phase& given = second;
        for (int i = 0; i < space.rows; ++i)
            given.impulse[i] = i < m ? base[i] : 0.0;
        given.carry(space, after, pushed);
        solve_phase(space, pushed, base, second, workspace, report);
        for (int i = 0; i < m; ++i)
            second.impulse[i] += base[i];
        second.sum(problem, space, rows);
    }

    // energies along p1 and p1 + s p2, from the motion itself: exact to rounding however dependent the rows
    // are
    const double* before = problem.velocity.data();
    const int n = rows.n;
    double start = dot(first.force, before, n) * to_scaled - first.work;
    const double bend = 0.5 * dot(first.force, first.change, n);
    // rounding only: an exact compression never adds energy
    const double kept = start + bend <= 0.0 || bend <= 0.0 ? 1.0 : std::clamp(-start / bend, 0.0, 1.0);
    start = kept * (start + kept * bend);
    double share = 1.0;
    double energy = start;
    if (bounces) {
        const double slope = dot(second.force, before, n) * to_scaled +
                             kept * dot(second.force, first.change, n) - second.work;
        const double curve = 0.5 * dot(second.force, second.change, n);
        share = largest_share(start, slope, curve);
        energy = start + share * (slope + share * curve);
    }

    for (int k = 0; k < n; ++k) {
        double force = kept * first.force[k];
        double change = kept * first.change[k];
        if (bounces) {
            force += share * second.force[k];
            change += share * second.change[k];
        }
        solution.momentum_change[k] = rows.speed * force;
        solution.velocity[k] += rows.speed * change;
    }
    const auto total = [&](int row, int contact) {
        const double p = kept * first.impulse[row] + (bounces ? share * second.impulse[row] : 0.0);
        return rows.speed * rows.scale[contact] * p;
    };
    for (int i = 0; i < m; ++i) {
        solution.normal_impulse[i] = total(i, i);
        if (const int t = space.tangent_row[i]; t >= 0) {
            const double limit = space.friction[i] * solution.normal_impulse[i];
            solution.tangent_impulse[i] = std::clamp(total(t, i), -limit, limit);
        }
    }
    solution.energy_change = rows.speed * rows.speed * energy;
    solution.restitution_scale = share;
    solution.iterations = report.iterations;
    solution.squeezed = report.squeezed;
    solution.fell_back = report.fell_back;
}

} // namespace

void CollisionProblem::resize(int freedoms, int contacts) {
    const int n = std::clamp(freedoms, 1, k_max_collision_freedoms);
    const int m = std::clamp(contacts, 0, k_max_collision_contacts);
    inverse_mass.resize(n, n);
    velocity.resize(n);
    normal_rows.resize(m, n);
    tangent_rows.resize(m, n);
    wall_normal_velocity.setZero(m);
    wall_tangent_velocity.setZero(m);
    restitution.setZero(m);
    friction.setZero(m);
}

void resolve_collisions(CollisionMethod method, const CollisionProblem& problem,
                        CollisionWorkspace& workspace, CollisionSolution& solution) noexcept {
    solution.velocity = problem.velocity;
    solution.momentum_change.setZero(problem.freedoms());
    solution.normal_impulse.setZero(problem.contacts());
    solution.tangent_impulse.setZero(problem.contacts());
    solution.energy_change = 0.0;
    solution.restitution_scale = 1.0;
    solution.iterations = 0;
    solution.squeezed = 0;
    solution.fell_back = false;
    if (method == CollisionMethod::poisson && problem.contacts() == 1 && !(problem.friction[0] > 0.0))
        resolve_one(problem, solution);
    else if (method == CollisionMethod::poisson)
        resolve_by_poisson(problem, workspace, solution);
    else
        detail::resolve_for_comparison(method, problem, workspace, solution);
}

} // namespace haptics
