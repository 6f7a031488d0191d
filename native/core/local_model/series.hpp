#pragma once
// Power series in u over one interval 0 <= u <= 1, and where a condition on them first ends.

#include <array>

namespace haptics::local {

inline constexpr int k_max_terms = 40;
using Series = std::array<double, k_max_terms>;

// A condition holds as long as at least one of its series is positive.
struct Condition {
    std::array<Series, 2> series;
    // size of what the series was computed from, per series: sets what counts as zero
    std::array<double, 2> scale{0.0, 0.0};
    int count{1};
    int terms{0};
};

struct FirstEnd {
    // the condition ends at `at`; otherwise it holds (within rounding) up to `at`
    bool ends{false};
    double at{1.0};
};

double value_at(const Series& series, int terms, double u);

// First u in [0, limit] where the condition ends. Cannot step over an end, however short; bounded, see
// FirstEnd::at.
FirstEnd first_end(const Condition& condition, double limit);

} // namespace haptics::local
