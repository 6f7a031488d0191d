#include "host.hpp"

#include <sched.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace haptics::bench {
namespace {

double seconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string one_digit(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed, 1).ptr;
    return {text, end};
}

} // namespace

std::string pin_to_one_core() {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0)
        return std::string("not pinned: ") + std::strerror(errno);
    int chosen = -1;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
        if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed))
            chosen = cpu;
    if (const char* wanted = std::getenv("HAPTICS_BENCH_CPU"))
        chosen = std::clamp(std::atoi(wanted), 0, CPU_SETSIZE - 1);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(chosen), &one);
    if (sched_setaffinity(0, sizeof(one), &one) != 0)
        return "not pinned to " + std::to_string(chosen) + ": " + std::strerror(errno);
    return std::to_string(chosen);
}

HostShare::HostShare()
    : steal_known_(steal_.begin())
    , real_start_(seconds(CLOCK_MONOTONIC))
    , own_start_(seconds(CLOCK_THREAD_CPUTIME_ID)) {}

std::string HostShare::json() const {
    const double real = seconds(CLOCK_MONOTONIC) - real_start_;
    const double own = seconds(CLOCK_THREAD_CPUTIME_ID) - own_start_;
    const std::optional<double> stolen = steal_known_ ? steal_.fraction() : std::nullopt;
    return "{\"stolen_percent\": " + (stolen ? one_digit(100.0 * *stolen) : "null") +
           ", \"own_percent\": " + one_digit(real > 0.0 ? 100.0 * own / real : 100.0) + "}";
}

} // namespace haptics::bench
