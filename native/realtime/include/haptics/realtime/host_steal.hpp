#pragma once
/// How much processor time the host took from this (virtual) machine: look at it before judging a late wake.

#include <cstdint>
#include <optional>
#include <string_view>

namespace haptics {

/// Processor time since boot, all processors together (clock ticks, usually 10 ms).
struct ProcessorTimes {
    /// All states together.
    std::uint64_t total{0};
    /// Taken by the host.
    std::uint64_t stolen{0};
};

/// Reads the first line of /proc/stat. Nothing when the text does not look like it.
[[nodiscard]] std::optional<ProcessorTimes> parse_processor_times(std::string_view text);

/// Share of processor time stolen since begin(). Main thread only: it reads a file.
class HostSteal {
  public:
    /// Remembers where the counters stand. False when /proc/stat cannot be read.
    bool begin();
    /// Stolen share of all processors' time since begin(), 0..1; nothing when /proc/stat cannot be read.
    [[nodiscard]] std::optional<double> fraction() const;

  private:
    ProcessorTimes start_;
};

} // namespace haptics
