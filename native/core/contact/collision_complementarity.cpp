/// Lemke's method (Cottle, Pang and Stone, "The Linear Complementarity Problem", algorithm 4.4.5): follow the
/// path of solutions of w = M z + q + z0, w, z, z0 >= 0, w z = 0 from z0 large enough to z0 = 0. One pivot
/// exchanges a basic and a nonbasic variable; the variable that enters next is the complement of the one that
/// left.

#include <cmath>

#include "collision_solver.hpp"

namespace haptics::detail {
namespace {

/// Rows are the basic variables, columns the nonbasic ones and, last, the constant. Variable i < n is w_i, n
/// + i is z_i, 2 n is z0.
struct Tableau {
    double* value;
    int n;
    int basic[CollisionWorkspace::k_complementarity];
    int nonbasic[CollisionWorkspace::k_complementarity + 1];

    [[nodiscard]] double* row(int i) const { return value + i * (n + 2); }
    [[nodiscard]] int complement(int variable) const { return variable < n ? variable + n : variable - n; }

    void pivot(int r, int c) {
        double* leaving = row(r);
        const double inverse = 1.0 / leaving[c];
        for (int j = 0; j < n + 2; ++j)
            leaving[j] *= -inverse;
        leaving[c] = inverse;
        for (int i = 0; i < n; ++i) {
            double* other = row(i);
            const double factor = other[c];
            if (i == r || factor == 0.0)
                continue;
            other[c] = 0.0;
            for (int j = 0; j < n + 2; ++j)
                other[j] += factor * leaving[j];
        }
        const int left = basic[r];
        basic[r] = nonbasic[c];
        nonbasic[c] = left;
    }
};

} // namespace

bool solve_complementarity(double* values, int n, double* z, SolverReport& report) noexcept {
    Tableau tableau{values, n, {}, {}};
    const int constant = n + 1;
    int r = 0;
    for (int i = 0; i < n; ++i) {
        tableau.basic[i] = i;
        tableau.nonbasic[i] = n + i;
        tableau.row(i)[n] = 1.0;
        z[i] = 0.0;
        if (tableau.row(i)[constant] < tableau.row(r)[constant])
            r = i;
    }
    tableau.nonbasic[n] = 2 * n;
    if (n == 0 || tableau.row(r)[constant] >= 0.0)
        return true;

    int entering = tableau.complement(tableau.basic[r]);
    tableau.pivot(r, n);
    const int bound = 4 * n + 16;
    for (int iteration = 0; iteration < bound && report.pivot_work > 0; ++iteration) {
        ++report.iterations;
        report.pivot_work -= n * (n + 2);
        int c = 0;
        while (tableau.nonbasic[c] != entering)
            ++c;
        // the first basic variable to reach zero; among (nearly) equal ones z0, then the largest pivot
        double least = HUGE_VAL;
        for (int i = 0; i < n; ++i) {
            const double slope = tableau.row(i)[c];
            if (slope < -1e-11)
                least = std::fmin(least, (std::fmax(tableau.row(i)[constant], 0.0) + 1e-13) / -slope);
        }
        r = -1;
        for (int i = 0; i < n; ++i) {
            const double slope = tableau.row(i)[c];
            if (slope >= -1e-11 || std::fmax(tableau.row(i)[constant], 0.0) > least * -slope)
                continue;
            if (tableau.basic[i] == 2 * n) {
                r = i;
                break;
            }
            if (r < 0 || slope < tableau.row(r)[c])
                r = i;
        }
        if (r < 0)
            return false;
        const int left = tableau.basic[r];
        tableau.pivot(r, c);
        if (left == 2 * n) {
            for (int i = 0; i < n; ++i) {
                if (tableau.basic[i] >= n)
                    z[tableau.basic[i] - n] = std::fmax(0.0, tableau.row(i)[constant]);
            }
            return true;
        }
        entering = tableau.complement(left);
    }
    return false;
}

} // namespace haptics::detail
