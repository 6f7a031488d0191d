#include <haptics/realtime/loop_clock.hpp>
#include <haptics/realtime/loop_schedule.hpp>
#include <haptics/realtime/loop_thread.hpp>

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <sstream>
#include <system_error>

namespace haptics {

namespace {

// room for steps, and for the near megabyte that a sanitizer keeps there; only what is touched takes memory
constexpr std::size_t k_stack_bytes = std::size_t{1} << 22;
constexpr std::size_t k_touched_bytes = std::size_t{1} << 18;
constexpr std::size_t k_page_bytes = 4096;

// the loop that runs on this thread: stop() must not wait for itself
constinit thread_local const LoopThread* t_own_loop = nullptr;

// touches the stack that steps will use, so that none of them waits for a page
[[gnu::noinline]] void touch_stack() noexcept {
    volatile char pages[k_touched_bytes];
    for (std::size_t i = 0; i < k_touched_bytes; i += k_page_bytes) {
        pages[i] = 1;
    }
    static_cast<void>(pages[0]);
}

void sleep_until(std::int64_t wake_ns) noexcept {
    timespec wake{};
    wake.tv_sec = wake_ns / 1000000000;
    wake.tv_nsec = wake_ns % 1000000000;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
    }
}

// one writer: load and store instead of a locked add
void increase(std::atomic<std::uint64_t>& counter, std::int64_t by) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + static_cast<std::uint64_t>(by),
                  std::memory_order_relaxed);
}

Grant ask_for_processor(int cpu) noexcept {
    Grant grant{cpu >= 0, false, 0};
    if (!grant.asked) {
        return grant;
    }
    if (cpu >= CPU_SETSIZE) {
        grant.error = EINVAL;
        return grant;
    }
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(cpu), &set);
    grant.error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    grant.granted = grant.error == 0;
    return grant;
}

Grant ask_for_fifo(int priority) noexcept {
    Grant grant{priority > 0, false, 0};
    if (!grant.asked) {
        return grant;
    }
    sched_param parameters{};
    parameters.sched_priority = priority;
    // a process started from within a step must not inherit the priority
    grant.granted = sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0;
    grant.error = grant.granted ? 0 : errno;
    return grant;
}

// signals go to other threads; those a fault in the step itself raises stay
sigset_t signals_of_others() noexcept {
    sigset_t set;
    sigfillset(&set);
    for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) {
        sigdelset(&set, own);
    }
    return set;
}

} // namespace

LoopThread::~LoopThread() {
    stop();
}

bool LoopThread::start(LoopStep& step, const LoopOptions& options) {
    if (running()) {
        return true;
    }
    // a loop that a request or an exception has ended
    stop();

    options_ = options;
    options_.priority = std::clamp(options.priority, 0, k_max_priority);
    report_ = SchedulingReport{};
    failed_.store(false, std::memory_order_relaxed);
    if (!is_valid_rate(options.rate_hz)) {
        std::ostringstream text;
        text << "the haptic rate is " << options.rate_hz << " Hz; set it between " << k_min_rate_hz << " and "
             << k_max_rate_hz << " Hz.";
        report_.failure = text.str();
        return false;
    }
    report_.rate_hz = options_.rate_hz;
    report_.period_ns = period_ns(options_.rate_hz);
    report_.priority = options_.priority;
    report_.cpu = options_.cpu;
    step_ = &step;
    steps_.store(0, std::memory_order_relaxed);
    missed_deadlines_.store(0, std::memory_order_relaxed);
    skipped_periods_.store(0, std::memory_order_relaxed);
    wake_latency_.clear();
    step_time_.clear();
    stop_requested_.store(false, std::memory_order_relaxed);
    prepared_.store(false, std::memory_order_relaxed);
    grants_.take(options_, report_);

    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, k_stack_bytes);
    const sigset_t blocked = signals_of_others();
    sigset_t before;
    pthread_sigmask(SIG_BLOCK, &blocked, &before);
    const int error = pthread_create(&thread_, &attributes, &LoopThread::entry, this);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    pthread_attr_destroy(&attributes);
    if (error != 0) {
        grants_.give_back();
        report_.failure = "no thread could be made (" + std::generic_category().message(error) +
                          "); close other programs or raise the limit of processes (ulimit -u).";
        return false;
    }
    joinable_ = true;
    prepared_.wait(false, std::memory_order_acquire);
    return true;
}

void LoopThread::stop() noexcept {
    request_stop();
    if (t_own_loop == this || !joinable_) {
        return;
    }
    pthread_join(thread_, nullptr);
    joinable_ = false;
    grants_.give_back();
}

std::string LoopThread::failure() const {
    return failed_.load(std::memory_order_acquire) ? std::string(failure_.data()) : std::string();
}

LoopStatistics LoopThread::statistics() const noexcept {
    LoopStatistics copy;
    copy.steps = steps_.load(std::memory_order_relaxed);
    copy.missed_deadlines = missed_deadlines_.load(std::memory_order_relaxed);
    copy.skipped_periods = skipped_periods_.load(std::memory_order_relaxed);
    copy.wake_latency = wake_latency_.snapshot();
    copy.step_time = step_time_.snapshot();
    return copy;
}

void* LoopThread::entry(void* self) noexcept {
    auto* const loop = static_cast<LoopThread*>(self);
    t_own_loop = loop;
    loop->prepare();
    loop->step_->loop_begins();
    loop->run();
    loop->step_->loop_ends();
    loop->running_.store(false, std::memory_order_release);
    return nullptr;
}

void LoopThread::prepare() noexcept {
    pthread_setname_np(pthread_self(), "haptic-loop");
    // without SCHED_FIFO the kernel may add 50 us to each sleep to save power
    prctl(PR_SET_TIMERSLACK, 1UL);
    report_.affinity = ask_for_processor(options_.cpu);
    report_.fifo = ask_for_fifo(options_.priority);
    touch_stack();
    running_.store(true, std::memory_order_release);
    prepared_.store(true, std::memory_order_release);
    prepared_.notify_one();
}

void LoopThread::run() noexcept {
    LoopSchedule schedule(loop_clock_ns() + report_.period_ns, report_.period_ns);
    while (!stop_requested_.load(std::memory_order_acquire)) {
        sleep_until(schedule.due_ns());
        if (stop_requested_.load(std::memory_order_acquire)) {
            return;
        }
        const std::int64_t woke = loop_clock_ns();
        wake_latency_.add(woke - schedule.due_ns());
        if (!run_step(schedule.begin_step(woke))) {
            return;
        }
        const std::int64_t ended = loop_clock_ns();
        step_time_.add(ended - woke);
        const LoopSchedule::Outcome outcome = schedule.end_step(ended);
        increase(missed_deadlines_, outcome.missed ? 1 : 0);
        increase(skipped_periods_, outcome.skipped);
        increase(steps_, 1);
    }
}

bool LoopThread::run_step(const StepTime& time) noexcept {
    try {
        step_->step(time);
        return true;
    } catch (const std::exception& error) {
        keep_failure(error.what());
    } catch (...) {
        keep_failure("an exception that is no std::exception");
    }
    return false;
}

void LoopThread::keep_failure(const char* what) noexcept {
    std::strncpy(failure_.data(), what, failure_.size() - 1);
    failed_.store(true, std::memory_order_release);
}

} // namespace haptics
