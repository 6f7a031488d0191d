#pragma once
/// What a loop is granted for the whole process rather than for its thread: locked memory and shallow
/// processor sleep.

#include <haptics/realtime/loop_options.hpp>
#include <haptics/realtime/scheduling_report.hpp>

namespace haptics {

/// Holds them between take() and give_back(). Main thread; allocates nothing, makes system calls.
class ProcessGrants {
  public:
    ProcessGrants() = default;
    ProcessGrants(const ProcessGrants&) = delete;
    ProcessGrants& operator=(const ProcessGrants&) = delete;
    /// Gives back.
    ~ProcessGrants();

    /// Asks for what `options` wants and writes the outcome into memory, memory_limit_bytes, cpu_latency and
    /// throttling of `report`.
    void take(const LoopOptions& options, SchedulingReport& report) noexcept;
    /// Gives everything back. Memory is unlocked when the last of several loops gives it back.
    void give_back() noexcept;

  private:
    bool holds_memory_{false};
    int latency_file_{-1};
};

} // namespace haptics
