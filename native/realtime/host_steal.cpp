#include <haptics/realtime/host_steal.hpp>

#include <array>
#include <charconv>
#include <fstream>
#include <string>

namespace haptics {

namespace {

std::optional<ProcessorTimes> read_processor_times() {
    std::ifstream file("/proc/stat");
    std::string line;
    if (!std::getline(file, line)) {
        return std::nullopt;
    }
    return parse_processor_times(line);
}

} // namespace

std::optional<ProcessorTimes> parse_processor_times(std::string_view text) {
    // "cpu  user nice system idle iowait irq softirq steal guest guest_nice"; guest is already in user
    constexpr std::size_t k_fields = 8;
    constexpr std::string_view k_head = "cpu ";
    if (text.substr(0, k_head.size()) != k_head) {
        return std::nullopt;
    }
    ProcessorTimes times;
    const char* at = text.data() + k_head.size();
    const char* const end = text.data() + text.size();
    for (std::size_t field = 0; field < k_fields; ++field) {
        while (at != end && *at == ' ') {
            ++at;
        }
        std::uint64_t value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{}) {
            return std::nullopt;
        }
        at = next;
        times.total += value;
        times.stolen = value;
    }
    return times;
}

bool HostSteal::begin() {
    const auto now = read_processor_times();
    start_ = now.value_or(ProcessorTimes{});
    return now.has_value();
}

std::optional<double> HostSteal::fraction() const {
    const auto now = read_processor_times();
    if (!now) {
        return std::nullopt;
    }
    const std::uint64_t total = now->total - start_.total;
    return total == 0 ? 0.0 : static_cast<double>(now->stolen - start_.stolen) / static_cast<double>(total);
}

} // namespace haptics
