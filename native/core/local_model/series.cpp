// The first end of a condition e(u) > 0.
//
// On [0, limit] the second derivative of e is at most L = sum j (j - 1) |e_j| limit^(j-2) in size, so
//     e(u + s) >= e(u) + e'(u) s - L s^2 / 2,
// which stays positive for s below (e' + sqrt(e'^2 + 2 L e)) / L. Stepping on by this s never passes an end;
// near a simple end it converges quadratically, like Newton's method; a near miss costs about two steps per
// digit of its height. Of several series, of which one has to be positive, the one that reaches farthest
// gives the step.
//
// A condition often starts at its own boundary: a contact that has just closed presses with force zero. Then
// values within rounding count as zero, and the sign with which e leaves zero decides, looked for at u =
// 2^-40, 2^-39, ...: the lowest power that is there wins.

#include "series.hpp"

#include <algorithm>
#include <cmath>

namespace haptics::local {
namespace {

constexpr int k_max_marches = 200;
// share of the scale that counts as zero: some times the rounding of the longest sum
constexpr double k_zero = 1e-14;

struct Value {
    double value;
    double slope;
};

Value evaluate(const Series& series, int terms, double u) {
    Value v{0.0, 0.0};
    for (int j = terms - 1; j >= 0; --j) {
        v.slope = v.slope * u + v.value;
        v.value = v.value * u + series[static_cast<std::size_t>(j)];
    }
    return v;
}

// bound of the second derivative on [0, limit]
double bend(const Series& series, int terms, double limit) {
    double sum = 0.0;
    for (int j = terms - 1; j >= 2; --j)
        sum = sum * limit + j * (j - 1) * std::abs(series[static_cast<std::size_t>(j)]);
    return sum;
}

// the largest change on [0, limit]
double swing(const Series& series, int terms, double limit) {
    double sum = 0.0;
    for (int j = terms - 1; j >= 1; --j)
        sum = (sum + std::abs(series[static_cast<std::size_t>(j)])) * limit;
    return sum;
}

enum class Sign { negative, zero, positive };

Sign sign_at(const Condition& c, double u) {
    Sign sign = Sign::negative;
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.count); ++i) {
        const double value = value_at(c.series[i], c.terms, u);
        const double zero = k_zero * c.scale[i];
        if (value > zero)
            return Sign::positive;
        if (value >= -zero)
            sign = Sign::zero;
    }
    return sign;
}

// from where on a condition that starts at zero holds
FirstEnd leave_zero(const Condition& c, double limit) {
    for (int halvings = 40; halvings >= 0; --halvings) {
        const double u = std::ldexp(limit, -halvings);
        const Sign sign = sign_at(c, u);
        if (sign != Sign::zero)
            return {sign == Sign::negative, u};
    }
    return {false, limit};
}

} // namespace

double value_at(const Series& series, int terms, double u) {
    double value = 0.0;
    for (int j = terms - 1; j >= 0; --j)
        value = value * u + series[static_cast<std::size_t>(j)];
    return value;
}

FirstEnd first_end(const Condition& c, double limit) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.count); ++i)
        if (c.series[i][0] - swing(c.series[i], c.terms, limit) > k_zero * c.scale[i])
            return {false, limit};
    double u = 0.0;
    const Sign start = sign_at(c, 0.0);
    if (start == Sign::negative)
        return {true, 0.0};
    if (start == Sign::zero) {
        const FirstEnd left = leave_zero(c, limit);
        if (left.ends)
            return {true, 0.0};
        u = left.at;
    }
    std::array<double, 2> bends{0.0, 0.0};
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.count); ++i)
        bends[i] = bend(c.series[i], c.terms, limit);
    for (int march = 0; march < k_max_marches && u < limit; ++march) {
        double safe = 0.0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(c.count); ++i) {
            const Value e = evaluate(c.series[i], c.terms, u);
            if (e.value <= k_zero * c.scale[i])
                continue;
            const double root = std::sqrt(e.slope * e.slope + 2.0 * bends[i] * e.value);
            // both forms are the same; each is free of cancellation for one sign of the slope
            const double step = e.slope < 0.0 ? 2.0 * e.value / (root - e.slope)
                                              : (bends[i] > 0.0 ? (e.slope + root) / bends[i] : limit);
            safe = std::max(safe, step);
        }
        if (safe <= 1e-16 * u)
            return {true, u};
        u += safe;
    }
    return {false, std::min(u, limit)};
}

} // namespace haptics::local
