#include <haptics/sweep/timing.hpp>

#include <algorithm>
#include <cstddef>
#include <ctime>

namespace haptics::sweep {

namespace {

// time that this thread had the processor, ns: what others do meanwhile does not count
double processor_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

} // namespace

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&values](std::size_t quarter) { return values[quarter * (values.size() - 1) / 4]; };
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    return {at(1), median, at(3)};
}

Spread time_calls(const std::function<void()>& start, const std::function<void()>& work, long calls,
                  int repeats) {
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) {
        start();
        const double from = processor_ns();
        for (long k = 0; k < calls; ++k)
            work();
        times.push_back((processor_ns() - from) / static_cast<double>(calls));
    }
    return spread_of(std::move(times));
}

} // namespace haptics::sweep
