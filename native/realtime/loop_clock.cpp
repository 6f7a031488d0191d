#include <haptics/realtime/loop_clock.hpp>

#include <time.h>

namespace haptics {

std::int64_t loop_clock_ns() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

} // namespace haptics
