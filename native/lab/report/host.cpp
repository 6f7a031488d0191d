#include "host.hpp"

#include <ctime>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "csv.hpp"

namespace haptics::report {

namespace {

double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string processor() {
    std::ifstream in("/proc/cpuinfo");
    std::string line;
    while (std::getline(in, line))
        if (line.starts_with("model name"))
            return line.substr(line.find(':') + 2);
    return "unknown";
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    tm parts{};
    gmtime_r(&now, &parts);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
    return text;
}

} // namespace

HostWatch::HostWatch()
    : real_(seconds_of(CLOCK_MONOTONIC))
    , own_(seconds_of(CLOCK_PROCESS_CPUTIME_ID))
    , steal_known_(steal_.begin()) {}

void HostWatch::write(const Options& options) const {
    const double took = seconds_of(CLOCK_MONOTONIC) - real_;
    const double ran = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - own_;
    CsvFile csv(options.folder / "host.csv", {"what", "value"});
    csv.row({"processor", processor()});
    csv.row({"processors", static_cast<int>(std::thread::hardware_concurrency())});
#ifdef __clang__
    csv.row({"compiler", "clang " __clang_version__});
#else
    csv.row({"compiler", "g++ " __VERSION__});
#endif
    csv.row({"flags", HAPTICS_REPORT_FLAGS});
    csv.row({"date", today()});
    csv.row({"extent", options.quick ? "quick" : "full"});
    csv.row({"repeats", options.repeats()});
    csv.row({"time_taken_s", took});
    csv.row({"own_processor_percent", 100.0 * ran / took});
    const std::optional<double> stolen = steal_known_ ? steal_.fraction() : std::nullopt;
    csv.row({"stolen_by_host_percent", stolen ? Field(100.0 * *stolen) : Field("unknown")});
    csv.finish();
}

} // namespace haptics::report
