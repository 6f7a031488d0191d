#include <haptics/realtime/scheduling_report.hpp>

#include <cerrno>
#include <sstream>
#include <system_error>

namespace haptics {

namespace {

std::string reason(int error) {
    return std::generic_category().message(error);
}

std::string outcome(const Grant& grant, const std::string& fix) {
    if (!grant.asked) {
        return "not asked for";
    }
    return grant.granted ? "granted" : "refused (" + reason(grant.error) + "). " + fix;
}

std::string limits_line(const std::string& item, const std::string& value) {
    return "Add the line \"" + std::string("@audio - ") + item + " " + value +
           "\" to /etc/security/limits.d/90-haptics.conf, put yourself into the group (sudo usermod -aG "
           "audio $USER) "
           "and log in again";
}

std::string fifo_fix(int priority) {
    const std::string value = std::to_string(priority);
    return limits_line("rtprio", value) +
           "; in a container start it with --cap-add=SYS_NICE --ulimit rtprio=" + value +
           ". Until then wakes come late by milliseconds when the machine is busy.";
}

std::string memory_fix(std::int64_t limit_bytes) {
    const std::string now =
        limit_bytes < 0 ? std::string() : "The limit is " + std::to_string(limit_bytes / 1024) + " kB. ";
    return now + limits_line("memlock", "unlimited") + "; in a container start it with --ulimit memlock=-1.";
}

std::string latency_fix(int error) {
    if (error == ENOENT) {
        return "This machine has no /dev/cpu_dma_latency (usual in containers); nothing to do but to run "
               "outside.";
    }
    return "Put KERNEL==\"cpu_dma_latency\", GROUP=\"audio\", MODE=\"0660\" into "
           "/etc/udev/rules.d/90-haptics.rules, "
           "be in that group, and restart.";
}

} // namespace

bool SchedulingReport::complete() const {
    return failure.empty() && fifo.satisfied() && memory.satisfied() && cpu_latency.satisfied() &&
           affinity.satisfied();
}

std::string SchedulingReport::describe() const {
    std::ostringstream text;
    if (!failure.empty()) {
        text << "The haptic loop did not start: " << failure << "\n";
        return text.str();
    }
    text << "Haptic loop at " << rate_hz << " Hz (period " << period_ns << " ns)\n";
    text << "  SCHED_FIFO" << (fifo.asked ? " priority " + std::to_string(priority) : "") << ": "
         << outcome(fifo, fifo_fix(priority)) << "\n";
    text << "  memory lock: " << outcome(memory, memory_fix(memory_limit_bytes)) << "\n";
    text << "  cpu latency 0: " << outcome(cpu_latency, latency_fix(cpu_latency.error)) << "\n";
    if (affinity.asked) {
        text << "  processor " << cpu << ": "
             << outcome(affinity,
                        "Choose one that this process may use (taskset -cp $$ lists them), or -1 for any.")
             << "\n";
    }
    if (fifo.granted && !throttling) {
        text << "  warning: real-time throttling is off, so a runaway step can freeze the machine. Fix: "
                "sudo sysctl kernel.sched_rt_runtime_us=950000\n";
    }
    return text.str();
}

std::string SchedulingReport::summary() const {
    if (!failure.empty()) {
        return "not started";
    }
    std::string text;
    const auto add = [&text](const Grant& grant, const std::string& name) {
        if (grant.asked) {
            text += (text.empty() ? "" : ", ") + std::string(grant.granted ? "" : "no ") + name;
        }
    };
    add(fifo, "SCHED_FIFO " + std::to_string(priority));
    add(memory, "memory lock");
    add(cpu_latency, "cpu latency hold");
    add(affinity, "processor " + std::to_string(cpu));
    return text.empty() ? "ordinary scheduling" : text;
}

} // namespace haptics
