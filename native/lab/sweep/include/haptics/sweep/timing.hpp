#pragma once
/// Run time of short work on a machine that does other things too: repeats, of which the median counts.

#include <functional>
#include <vector>

namespace haptics::sweep {

/// Median and quartiles.
struct Spread {
    double low{0.0};
    double median{0.0};
    double high{0.0};
};

/// Of at least one value.
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// Processor time in ns that one call of `work` takes; `calls` of them after `start`, `repeats` times.
[[nodiscard]] Spread time_calls(const std::function<void()>& start, const std::function<void()>& work,
                                long calls, int repeats);

} // namespace haptics::sweep
