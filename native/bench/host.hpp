#pragma once
/// The machine that the benchmarks run on: one core for all of them, and what else went on meanwhile.

#include <haptics/realtime/host_steal.hpp>

#include <optional>
#include <string>

namespace haptics::bench {

/// Keeps this thread on one processor: the last one that it may use, or the one that the environment names in
/// HAPTICS_BENCH_CPU. Returns its number, or why it cannot be.
std::string pin_to_one_core();

/// What the host and other processes took while the benchmarks ran.
class HostShare {
  public:
    HostShare();
    /// As a JSON object: stolen_percent of all processors' time (null when it cannot be read), own_percent of
    /// this thread's time that it really ran.
    [[nodiscard]] std::string json() const;

  private:
    HostSteal steal_;
    bool steal_known_{false};
    double real_start_{0.0};
    double own_start_{0.0};
};

} // namespace haptics::bench
