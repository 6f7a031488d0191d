/// The two methods that the default is compared with. Both take the closing contacts only (v_n < 0), want v+
/// = -e v- for each of them, and know no friction.
///
/// `paper`: eq. (5), q'+ = (J^T J)^-1 J^T v+. With fewer contacts than freedoms J^T J is singular; the
/// inverse is read as the pseudo-inverse, J^+ v+, singular values below 1e-9 of the largest left out. The
/// result has no part outside the row space of J: whatever the tool did there stops. It depends on the units
/// of the freedoms, as J^T J has no metric.
///
/// `mass_weighted`: the smallest change of motion in the D-norm that gives v+ (in the sense of least
/// squares). With D^-1 = L L^T and A = J L it is L A^+ (v+ - v-), made by impulses p = (A A^T)^+ (v+ - v-) of
/// either sign. With equal restitutions energy does not grow: L^-1 q' changes by -(1 + e) times its
/// projection onto the row space of A. With unequal ones it may.

#include <algorithm>
#include <cmath>

#include "collision_solver.hpp"

namespace haptics::detail {
namespace {

constexpr double k_truncation = 1e-9;
constexpr int k_jacobi_sweeps = 30;

/// D x by the factor of D^-1, in place.
void multiply_by_mass(const double* l, int n, FreedomVector& x) {
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < i; ++k)
            x[i] -= l[i * n + k] * x[k];
        x[i] /= l[i * n + i];
    }
    for (int i = n - 1; i >= 0; --i) {
        x[i] /= l[i * n + i];
        for (int k = 0; k < i; ++k)
            x[k] -= l[i * n + k] * x[i];
    }
}

} // namespace

void pseudo_solve(double* rows, int count, int width, double* vectors, const double* target, double* p,
                  int& iterations) noexcept {
    for (int i = 0; i < count * count; ++i)
        vectors[i] = 0.0;
    for (int i = 0; i < count; ++i)
        vectors[i * count + i] = 1.0;
    // turn pairs of rows until all are perpendicular: rows = U^T A, vectors = U^T
    for (int sweep = 0; sweep < k_jacobi_sweeps; ++sweep) {
        bool turned = false;
        ++iterations;
        for (int i = 0; i < count; ++i) {
            for (int j = i + 1; j < count; ++j) {
                double* x = rows + i * width;
                double* y = rows + j * width;
                double xx = 0.0;
                double xy = 0.0;
                double yy = 0.0;
                for (int k = 0; k < width; ++k) {
                    xx += x[k] * x[k];
                    xy += x[k] * y[k];
                    yy += y[k] * y[k];
                }
                if (std::fabs(xy) <= 1e-15 * std::sqrt(xx * yy) || xy == 0.0)
                    continue;
                turned = true;
                const double zeta = (yy - xx) / (2.0 * xy);
                const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::sqrt(1.0 + zeta * zeta));
                const double c = 1.0 / std::sqrt(1.0 + t * t);
                const double s = c * t;
                const auto turn = [c, s](double* a, double* b, int length) {
                    for (int k = 0; k < length; ++k) {
                        const double old = a[k];
                        a[k] = c * old - s * b[k];
                        b[k] = s * old + c * b[k];
                    }
                };
                turn(x, y, width);
                turn(vectors + i * count, vectors + j * count, count);
            }
        }
        if (!turned)
            break;
    }
    double square[k_max_collision_contacts];
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
        square[i] = 0.0;
        for (int k = 0; k < width; ++k)
            square[i] += rows[i * width + k] * rows[i * width + k];
        largest = std::fmax(largest, square[i]);
    }
    for (int i = 0; i < count; ++i)
        p[i] = 0.0;
    for (int i = 0; i < count; ++i) {
        if (!(square[i] > k_truncation * k_truncation * largest))
            continue;
        double share = 0.0;
        for (int k = 0; k < count; ++k)
            share += vectors[i * count + k] * target[k];
        share /= square[i];
        for (int k = 0; k < count; ++k)
            p[k] += share * vectors[i * count + k];
    }
}

void resolve_for_comparison(CollisionMethod method, const CollisionProblem& problem,
                            CollisionWorkspace& workspace, CollisionSolution& solution) noexcept {
    const int n = problem.freedoms();
    int closing[k_max_collision_contacts];
    double before[k_max_collision_contacts];
    int count = 0;
    for (int i = 0; i < problem.contacts(); ++i) {
        double v = -problem.wall_normal_velocity[i];
        for (int k = 0; k < n; ++k)
            v += problem.normal_rows(i, k) * problem.velocity[k];
        if (v < 0.0) {
            closing[count] = i;
            before[count++] = v;
        }
    }
    if (count == 0)
        return;
    double* l = workspace.mass_factor;
    factorize(problem.inverse_mass.data(), n, l);
    double target[k_max_collision_contacts];
    double p[k_max_collision_contacts];
    const auto restitution = [&](int c) { return std::clamp(problem.restitution[closing[c]], 0.0, 1.0); };

    // eq. (5)
    if (method == CollisionMethod::paper) {
        for (int c = 0; c < count; ++c) {
            target[c] = problem.wall_normal_velocity[closing[c]] - restitution(c) * before[c];
            for (int k = 0; k < n; ++k)
                workspace.jacobian[c * n + k] = problem.normal_rows(closing[c], k);
        }
        pseudo_solve(workspace.jacobian, count, n, workspace.factor, target, p, solution.iterations);
        solution.velocity.setZero(n);
        for (int c = 0; c < count; ++c)
            for (int k = 0; k < n; ++k)
                solution.velocity[k] += problem.normal_rows(closing[c], k) * p[c];
        for (int c = 0; c < count; ++c) {
            target[c] = 0.0;
            for (int k = 0; k < n; ++k)
                target[c] +=
                    problem.normal_rows(closing[c], k) * (solution.velocity[k] - problem.velocity[k]);
        }
    } else {
        for (int c = 0; c < count; ++c)
            target[c] = -(1.0 + restitution(c)) * before[c];
    }

    // impulses that make this change of normal velocities
    for (int c = 0; c < count; ++c) {
        double* row = workspace.jacobian + c * n;
        for (int k = 0; k < n; ++k)
            row[k] = 0.0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k <= i; ++k)
                row[k] += problem.normal_rows(closing[c], i) * l[i * n + k];
    }
    pseudo_solve(workspace.jacobian, count, n, workspace.factor, target, p, solution.iterations);
    for (int c = 0; c < count; ++c)
        solution.normal_impulse[closing[c]] = p[c];

    if (method == CollisionMethod::mass_weighted) {
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < count; ++c)
                solution.momentum_change[k] += problem.normal_rows(closing[c], k) * p[c];
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
                solution.velocity[k] += problem.inverse_mass(k, i) * solution.momentum_change[i];
    } else {
        solution.momentum_change = solution.velocity - problem.velocity;
        multiply_by_mass(l, n, solution.momentum_change);
    }
    solution.energy_change = 0.5 * solution.momentum_change.dot(solution.velocity + problem.velocity);
    for (int c = 0; c < count; ++c)
        solution.energy_change -= p[c] * problem.wall_normal_velocity[closing[c]];
}

} // namespace haptics::detail
