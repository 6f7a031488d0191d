// Motion under linear springs as a power series.
//
// With the set of acting springs fixed the motion is linear,
//     v' = a_0 + sum_e push_e f_e,   f_e = -K_e d_e - B_e d_e',   d_e' = row_e v - w_e.
// In u = t / h the displacement y from the start of an interval of length h is sum Y_j u^j with Y_0 = 0, Y_1
// = h v, and equal powers of u give
//     (j + 1)(j + 2) Y_(j+2) = h^2 (a_0 [j = 0] + sum_e push_e (-K_e d_ej - B_e (j + 1) d_e(j+1) / h)),
//     d_e(j) = row_e Y_j, plus d_e now for j = 0, less w_e h for j = 1.
// This is the exponential of the system applied to its state, without any matrix: a term costs one pass over
// the rows. Symmetry is not needed (sliding friction has none), nor proportional damping.
//
// Convergence. In the metric of the mass matrix the springs are bounded by p = sum K_e |row_e| |push_e|, the
// dampers by q = sum B_e |row_e| |push_e|, and with velocities measured in units of 1 / r the whole system by
// the root r of r^2 = q r + p. So the terms fall as (r h)^j / j!. Intervals end at r h = k_reach, where the
// largest term is about 3 times the first (no digits are lost), and the series ends where the bound is below
// k_series_rest. An interval covers at least a third of the period of the fastest mode that the bound allows,
// and more of the actual one.

#include "flow.hpp"

#include <cmath>

namespace haptics::local {
namespace {

constexpr double k_reach = 2.5;
constexpr double k_series_rest = 1e-17;
// two derivatives are taken of the series: a force and its rate
constexpr int k_more_terms = 2;

int terms_for(double reach) {
    double bound = 1.0;
    int terms = 1;
    while (bound > k_series_rest && terms < k_max_terms - k_more_terms)
        bound *= reach / terms++;
    return terms + k_more_terms;
}

} // namespace

void measure(Flow& flow) {
    double springs = 0.0;
    double dampers = 0.0;
    for (int e = 0; e < flow.rows; ++e) {
        const FlowRow& r = flow.row[static_cast<std::size_t>(e)];
        if (!r.acts)
            continue;
        springs += r.stiffness * r.mobility;
        dampers += r.damping * r.mobility;
    }
    flow.rate = 0.5 * (dampers + std::sqrt(dampers * dampers + 4.0 * springs));
}

double longest_span(const Flow& flow) {
    return k_reach / flow.rate;
}

namespace {

// N: freedoms when known at compile time, else 0
template <std::size_t N>
double along(const FlowVector& row, const FlowVector& motion, std::size_t freedoms) {
    const std::size_t n = N > 0 ? N : freedoms;
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k)
        sum += row[k] * motion[k];
    return sum;
}

template <std::size_t N>
void expand_terms(Flow& flow) {
    const std::size_t n = N > 0 ? N : static_cast<std::size_t>(flow.freedoms);
    const auto rows = static_cast<std::size_t>(flow.rows);
    const auto terms = static_cast<std::size_t>(flow.terms);
    const double span = flow.span;
    for (std::size_t k = 0; k < n; ++k) {
        flow.motion[0][k] = 0.0;
        flow.motion[1][k] = span * flow.velocity[k];
    }
    std::array<std::size_t, k_flow_rows> acting;
    std::size_t acting_count = 0;
    for (std::size_t e = 0; e < rows; ++e) {
        const FlowRow& r = flow.row[e];
        flow.shift[e][0] = r.displacement;
        flow.shift[e][1] = along<N>(r.row, flow.motion[1], n) - r.drive * span;
        if (r.acts)
            acting[acting_count++] = e;
    }
    for (std::size_t j = 0; j + 2 < terms; ++j) {
        FlowVector& next = flow.motion[j + 2];
        for (std::size_t k = 0; k < n; ++k)
            next[k] = j == 0 ? flow.free_acceleration[k] : 0.0;
        const auto power = static_cast<double>(j + 1);
        const double per_span = power / span;
        for (std::size_t a = 0; a < acting_count; ++a) {
            const FlowRow& r = flow.row[acting[a]];
            const Series& d = flow.shift[acting[a]];
            const double force = -r.stiffness * d[j] - r.damping * per_span * d[j + 1];
            for (std::size_t k = 0; k < n; ++k)
                next[k] += r.push[k] * force;
        }
        const double scale = span * span / (power * (power + 1.0));
        for (std::size_t k = 0; k < n; ++k)
            next[k] *= scale;
        for (std::size_t e = 0; e < rows; ++e)
            flow.shift[e][j + 2] = along<N>(flow.row[e].row, next, n);
    }
}

} // namespace

void expand(Flow& flow, double span) {
    flow.span = span;
    flow.terms = terms_for(flow.rate * span);
    switch (flow.freedoms) {
    case 3:
        expand_terms<3>(flow);
        return;
    case 6:
        expand_terms<6>(flow);
        return;
    default:
        expand_terms<0>(flow);
    }
}

void shorten(Flow& flow, double part) {
    double power = 1.0;
    for (std::size_t j = 1; j < static_cast<std::size_t>(flow.terms); ++j) {
        power *= part;
        for (std::size_t k = 0; k < static_cast<std::size_t>(flow.freedoms); ++k)
            flow.motion[j][k] *= power;
        for (std::size_t e = 0; e < static_cast<std::size_t>(flow.rows); ++e)
            flow.shift[e][j] *= power;
    }
    flow.span *= part;
}

double force_series(const Flow& flow, int row, Series& force) {
    const FlowRow& r = flow.row[static_cast<std::size_t>(row)];
    const Series& d = flow.shift[static_cast<std::size_t>(row)];
    const double damping = r.damping / flow.span;
    double scale = 0.0;
    for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(flow.terms); ++j) {
        const double spring = r.stiffness * d[j];
        const double damper = damping * static_cast<double>(j + 1) * d[j + 1];
        force[j] = -spring - damper;
        scale += std::abs(spring) + std::abs(damper);
    }
    return scale;
}

bool advance(Flow& flow, FlowVector& moved, FlowVector& moved_time) {
    const auto n = static_cast<std::size_t>(flow.freedoms);
    FlowVector end;
    FlowVector rate;
    FlowVector area;
    double check = 0.0;
    for (std::size_t k = 0; k < n; ++k)
        end[k] = rate[k] = area[k] = 0.0;
    // smallest terms first
    for (std::size_t j = static_cast<std::size_t>(flow.terms) - 1; j >= 1; --j) {
        const auto power = static_cast<double>(j);
        for (std::size_t k = 0; k < n; ++k) {
            end[k] += flow.motion[j][k];
            rate[k] += power * flow.motion[j][k];
            area[k] += flow.motion[j][k] / (power + 1.0);
        }
    }
    for (std::size_t k = 0; k < n; ++k)
        check += end[k] + rate[k];
    if (!std::isfinite(check))
        return false;
    for (std::size_t k = 0; k < n; ++k) {
        flow.velocity[k] = rate[k] / flow.span;
        moved_time[k] += flow.span * (moved[k] + area[k]);
        moved[k] += end[k];
    }
    for (std::size_t e = 0; e < static_cast<std::size_t>(flow.rows); ++e)
        flow.row[e].displacement = value_at(flow.shift[e], flow.terms, 1.0);
    return true;
}

} // namespace haptics::local
