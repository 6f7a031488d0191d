// Memory is locked on fault: pages stay once they were touched. The loop touches what it needs before it
// starts, and an engine's hundreds of megabytes of mapped but unused pages need not be filled for it.
#include <haptics/realtime/process_grants.hpp>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <mutex>

namespace haptics {

namespace {

std::mutex g_memory_mutex;
int g_memory_holders = 0;

// Root in a container may lock what is there and still be refused what comes later: every later allocation
// would then fail. A mapping just above the limit shows whether the limit counts.
bool limit_counts(rlim_t limit) noexcept {
    if (limit == RLIM_INFINITY) {
        return false;
    }
    const std::size_t size = limit + 4096;
    void* const probe = mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (probe == MAP_FAILED) {
        return true;
    }
    munmap(probe, size);
    return false;
}

int lock_process_memory(rlim_t limit) noexcept {
    const std::lock_guard lock(g_memory_mutex);
    if (g_memory_holders == 0) {
        if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
            return errno;
        }
        if (limit_counts(limit)) {
            munlockall();
            return ENOMEM;
        }
    }
    ++g_memory_holders;
    return 0;
}

void unlock_process_memory() noexcept {
    const std::lock_guard lock(g_memory_mutex);
    if (--g_memory_holders == 0) {
        munlockall();
    }
}

bool is_throttling() noexcept {
    const int file = open("/proc/sys/kernel/sched_rt_runtime_us", O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return true;
    }
    std::array<char, 16> text{};
    const ssize_t size = read(file, text.data(), text.size());
    close(file);
    return size <= 0 || text[0] != '-';
}

} // namespace

ProcessGrants::~ProcessGrants() {
    give_back();
}

void ProcessGrants::take(const LoopOptions& options, SchedulingReport& report) noexcept {
    report.throttling = is_throttling();

    rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    report.memory_limit_bytes =
        limit.rlim_cur == RLIM_INFINITY ? -1 : static_cast<std::int64_t>(limit.rlim_cur);
    report.memory.asked = options.lock_memory;
    if (options.lock_memory && !holds_memory_) {
        report.memory.error = lock_process_memory(limit.rlim_cur);
        holds_memory_ = report.memory.error == 0;
    }
    report.memory.granted = holds_memory_;

    // the kernel keeps to the wish as long as the file is open
    report.cpu_latency.asked = options.hold_cpu_latency;
    if (options.hold_cpu_latency && latency_file_ < 0) {
        latency_file_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
        const std::int32_t microseconds = 0;
        if (latency_file_ < 0) {
            report.cpu_latency.error = errno;
        } else if (write(latency_file_, &microseconds, sizeof microseconds) != sizeof microseconds) {
            report.cpu_latency.error = errno;
            close(latency_file_);
            latency_file_ = -1;
        }
    }
    report.cpu_latency.granted = latency_file_ >= 0;
}

void ProcessGrants::give_back() noexcept {
    if (latency_file_ >= 0) {
        close(latency_file_);
        latency_file_ = -1;
    }
    if (holds_memory_) {
        unlock_process_memory();
        holds_memory_ = false;
    }
}

} // namespace haptics
