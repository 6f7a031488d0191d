#include <haptics/realtime/scheduling_report.hpp>

#include <doctest/doctest.h>

#include <cerrno>
#include <string>

using haptics::Grant;
using haptics::SchedulingReport;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

SchedulingReport granted() {
    SchedulingReport report;
    report.rate_hz = 1000.0;
    report.period_ns = 1000000;
    report.priority = 80;
    report.fifo = Grant{true, true, 0};
    report.memory = Grant{true, true, 0};
    report.cpu_latency = Grant{true, true, 0};
    return report;
}

} // namespace

TEST_CASE("a report of granted wishes is short and complete") {
    const SchedulingReport report = granted();
    CHECK(report.complete());
    CHECK(report.summary() == "SCHED_FIFO 80, memory lock, cpu latency hold");
    CHECK(contains(report.describe(), "1000 Hz"));
    CHECK_FALSE(contains(report.describe(), "refused"));
    CHECK_FALSE(contains(report.describe(), "warning"));
}

TEST_CASE("each refusal says why and what to do") {
    SchedulingReport report = granted();
    report.fifo = Grant{true, false, EPERM};
    report.memory = Grant{true, false, ENOMEM};
    report.memory_limit_bytes = 8388608;
    report.cpu_latency = Grant{true, false, EACCES};
    report.affinity = Grant{true, false, EINVAL};
    report.cpu = 99;
    const std::string text = report.describe();
    CHECK_FALSE(report.complete());
    CHECK(contains(text, "SCHED_FIFO priority 80: refused (Operation not permitted)"));
    CHECK(contains(text, "\"@audio - rtprio 80\" to /etc/security/limits.d/"));
    CHECK(contains(text, "--cap-add=SYS_NICE"));
    CHECK(contains(text, "The limit is 8192 kB"));
    CHECK(contains(text, "\"@audio - memlock unlimited\""));
    CHECK(contains(text, "KERNEL==\"cpu_dma_latency\""));
    CHECK(contains(text, "processor 99: refused (Invalid argument)"));
    CHECK(report.summary() == "no SCHED_FIFO 80, no memory lock, no cpu latency hold, no processor 99");
}

TEST_CASE("what was not asked for is not a refusal") {
    SchedulingReport report;
    CHECK(report.complete());
    CHECK(report.summary() == "ordinary scheduling");
    CHECK(contains(report.describe(), "not asked for"));
}

TEST_CASE("a machine without throttling is warned of") {
    SchedulingReport report = granted();
    report.throttling = false;
    CHECK(contains(report.describe(), "kernel.sched_rt_runtime_us=950000"));
}

TEST_CASE("a loop that did not start says only that") {
    SchedulingReport report;
    report.failure = "the haptic rate is 5 Hz; set it between 250 and 10000 Hz.";
    CHECK_FALSE(report.complete());
    CHECK(report.summary() == "not started");
    CHECK(contains(report.describe(), "did not start: the haptic rate is 5 Hz"));
}
