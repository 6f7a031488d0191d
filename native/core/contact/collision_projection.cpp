/// Projection onto opening normals in the metric of D.
///
///     minimize E(p) = p^T G p / 2 + p^T v   over p >= 0,   G = J D^-1 J^T, v = J q'
///
/// is the dual of min |x - q'|_D over J x >= 0. Its optimality conditions are 0 <= p, 0 <= v + G p, p (v + G p) = 0, and
/// E(p) is exactly the kinetic energy that the impulses p add. The active-set method of Lawson and Hanson (1974) walks from
/// p = 0 through points p >= 0 with E strictly falling, so that it cannot cycle, ends at the optimum, and wherever it is
/// stopped the impulses so far neither pull nor add energy.
///
/// A normal that depends on the active ones opens a direction of constant G p along which E falls linearly. Either an
/// active impulse runs out along it (that contact leaves), or E has no lower bound: then no motion opens all these
/// contacts at once, which walls at rest cannot cause (x = 0 would do). Such a contact is excluded.

#include "collision_solver.hpp"

#include <cmath>

namespace haptics::detail {
namespace {

constexpr int k_stride = k_max_collision_contacts;

/// The active contacts and the Cholesky factor of their part of G.
struct ActiveSet {
    double* factor{nullptr};
    int count{0};
    int contact[k_max_collision_contacts];

    /// Forward substitution L y = b in place.
    void solve_lower(double* b) const {
        for (int i = 0; i < count; ++i) {
            const double* row = factor + i * k_stride;
            double sum = b[i];
            for (int j = 0; j < i; ++j)
                sum -= row[j] * b[j];
            b[i] = sum / row[i];
        }
    }
    /// Backward substitution L^T y = b in place.
    void solve_upper(double* b) const {
        for (int i = count - 1; i >= 0; --i) {
            b[i] /= factor[i * k_stride + i];
            for (int j = 0; j < i; ++j)
                b[j] -= factor[i * k_stride + j] * b[i];
        }
    }
    /// Appends a contact; `y` is L^-1 G_active,contact and `rest` > 0 what is left of its diagonal.
    void append(int added, const double* y, double rest) {
        double* row = factor + count * k_stride;
        for (int j = 0; j < count; ++j)
            row[j] = y[j];
        row[count] = std::sqrt(rest);
        contact[count++] = added;
    }
    /// Takes one contact out; Givens rotations bring the factor back to triangular form.
    void remove(int place) {
        for (int i = place; i + 1 < count; ++i) {
            contact[i] = contact[i + 1];
            double* row = factor + i * k_stride;
            const double* below = row + k_stride;
            for (int j = 0; j <= i + 1; ++j)
                row[j] = below[j];
        }
        --count;
        for (int i = place; i < count; ++i) {
            const double a = factor[i * k_stride + i];
            const double b = factor[i * k_stride + i + 1];
            const double length = std::sqrt(a * a + b * b);
            const double c = a / length;
            const double s = b / length;
            factor[i * k_stride + i] = length;
            for (int k = i + 1; k < count; ++k) {
                double* row = factor + k * k_stride;
                const double x = row[i];
                const double y = row[i + 1];
                row[i] = c * x + s * y;
                row[i + 1] = c * y - s * x;
            }
        }
    }
};

/// Two contacts: the four cases of the complementarity one by one. False where they are (nearly) dependent.
bool project_two(const ImpulseSpace& space, const double* v, double* p) {
    const double a = space.row(0)[0];
    const double b = space.row(0)[1];
    const double d = space.row(1)[1];
    const double det = a * d - b * b;
    if (det <= k_dependent * a * d)
        return false;
    p[0] = 0.0;
    p[1] = 0.0;
    if (v[0] >= -k_still && v[1] >= -k_still)
        return true;
    const double first = -v[0] / a;
    if (first > 0.0 && v[1] + b * first >= 0.0) {
        p[0] = first;
        return true;
    }
    const double second = -v[1] / d;
    if (second > 0.0 && v[0] + b * second >= 0.0) {
        p[1] = second;
        return true;
    }
    p[0] = std::fmax(0.0, (b * v[1] - d * v[0]) / det);
    p[1] = std::fmax(0.0, (b * v[0] - a * v[1]) / det);
    return true;
}

} // namespace

void project_normals(ImpulseSpace& space, const double* velocity, double* impulse, double* factor,
                     SolverReport& report) noexcept {
    const int m = space.contacts;
    if (m == 2 && !space.excluded[0] && !space.excluded[1] && project_two(space, velocity, impulse)) {
        ++report.iterations;
        return;
    }

    ActiveSet active;
    active.factor = factor;
    // asleep: met while dependent or by rounding only, not asked again
    bool asleep[k_max_collision_contacts];
    bool is_active[k_max_collision_contacts];
    double v[k_max_collision_contacts];
    for (int i = 0; i < m; ++i) {
        impulse[i] = 0.0;
        asleep[i] = space.excluded[i];
        is_active[i] = false;
        v[i] = velocity[i];
    }
    const auto leave = [&](int place) {
        impulse[active.contact[place]] = 0.0;
        is_active[active.contact[place]] = false;
        active.remove(place);
    };

    const int bound = 6 * m + 16;
    for (int iteration = 0;; ++iteration) {
        // the fastest closing contact
        int worst = -1;
        double worst_velocity = -k_still;
        for (int i = 0; i < m; ++i) {
            if (!asleep[i] && !is_active[i] && v[i] < worst_velocity) {
                worst_velocity = v[i];
                worst = i;
            }
        }
        if (worst < 0)
            return;
        if (iteration >= bound) {
            report.fell_back = true;
            return;
        }
        ++report.iterations;

        double y[k_max_collision_contacts];
        const double* row = space.row(worst);
        const auto split = [&] {
            for (int j = 0; j < active.count; ++j)
                y[j] = row[active.contact[j]];
            active.solve_lower(y);
            double rest = row[worst];
            for (int j = 0; j < active.count; ++j)
                rest -= y[j] * y[j];
            return rest;
        };
        double rest = split();
        if (rest <= k_dependent * row[worst]) {
            // slide along the direction of constant G p until an active impulse runs out
            double c[k_max_collision_contacts];
            for (int j = 0; j < active.count; ++j)
                c[j] = y[j];
            active.solve_upper(c);
            int blocking = -1;
            double reach = 0.0;
            for (int j = 0; j < active.count; ++j) {
                if (c[j] > 1e-9 && (blocking < 0 || impulse[active.contact[j]] < reach * c[j])) {
                    reach = impulse[active.contact[j]] / c[j];
                    blocking = j;
                }
            }
            asleep[worst] = true;
            if (worst_velocity > -1e-9)
                continue;
            if (blocking < 0) {
                space.excluded[worst] = true;
                ++report.squeezed;
                continue;
            }
            for (int j = 0; j < active.count; ++j) {
                double& p = impulse[active.contact[j]];
                p = std::fmax(0.0, p - reach * c[j]);
            }
            impulse[worst] = reach;
            leave(blocking);
            rest = split();
            if (rest <= 0.0) {
                impulse[worst] = 0.0;
                continue;
            }
            asleep[worst] = false;
        }
        active.append(worst, y, rest);
        is_active[worst] = true;

        // go to the lowest point of E over the active impulses, or as far as all of them stay >= 0
        for (bool inside = false; !inside && active.count > 0;) {
            double target[k_max_collision_contacts];
            for (int j = 0; j < active.count; ++j)
                target[j] = -velocity[active.contact[j]];
            active.solve_lower(target);
            active.solve_upper(target);
            double step = 1.0;
            int blocking = -1;
            for (int j = 0; j < active.count; ++j) {
                const double p = impulse[active.contact[j]];
                if (target[j] < 0.0 && p < step * (p - target[j])) {
                    step = p / (p - target[j]);
                    blocking = j;
                }
            }
            for (int j = 0; j < active.count; ++j) {
                double& p = impulse[active.contact[j]];
                p = std::fmax(0.0, p + step * (target[j] - p));
            }
            inside = blocking < 0;
            if (!inside) {
                ++report.iterations;
                // what was just added can only leave by rounding
                if (active.contact[blocking] == worst)
                    asleep[worst] = true;
                leave(blocking);
            }
        }
        for (int i = 0; i < m; ++i)
            v[i] = velocity[i];
        for (int j = 0; j < active.count; ++j) {
            const double p = impulse[active.contact[j]];
            const double* column = space.row(active.contact[j]);
            for (int i = 0; i < m; ++i)
                v[i] += column[i] * p;
        }
    }
}

} // namespace haptics::detail
