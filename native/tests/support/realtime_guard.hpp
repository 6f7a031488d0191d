#pragma once
/// Traps what a haptic step must not do: take or give memory, lock, wait, sleep, touch files, print, make
/// threads.
///
///     RealtimeGuard guard;                 // on any thread
///     guard.begin();                       // on the thread under guard
///     step(model, data, input);
///     guard.end();
///     CHECK(guard.violations() == 0);      // guard.first() names the first function called
///
/// The test program replaces the C library's functions by ones that look at the thread's guard and hand on.
/// Calls of the kernel that go around the C library (inline assembly) and waits inside the C library itself
/// are not seen that way; context_switches() sees them: a thread that never blocks never gives up its
/// processor.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptics::testing {

/// What a function does that a step must not.
enum class Violation : std::uint8_t {
    /// malloc, operator new and their kin.
    allocation,
    /// free, operator delete.
    deallocation,
    /// Mutexes, read-write locks, semaphores, condition variables, raw futexes.
    lock,
    /// nanosleep, usleep, poll, sched_yield and their kin; clock_nanosleep unless allowed.
    sleep,
    /// open, read, write, close, ioctl, mmap and their kin.
    file,
    /// printf, puts, fwrite and their kin.
    print,
    /// Making, joining threads.
    thread,
};
/// Number of kinds.
inline constexpr std::size_t k_violations = 7;

/// The guard of one thread at a time. Its counts may be read from any thread after end().
class RealtimeGuard {
  public:
    /// What else is allowed.
    struct Allowed {
        /// clock_nanosleep, for guarding the loop itself and not only a step.
        bool clock_nanosleep{false};
    };

    RealtimeGuard() = default;
    RealtimeGuard(const RealtimeGuard&) = delete;
    RealtimeGuard& operator=(const RealtimeGuard&) = delete;

    /// From here on this thread is guarded, until end(). Does nothing when it is already guarded by this.
    void begin(Allowed allowed) noexcept;
    /// The same, with nothing allowed.
    void begin() noexcept { begin(Allowed{}); }
    /// This thread is free again. Does nothing when it is not guarded by this.
    void end() noexcept;

    /// Violations of all kinds.
    [[nodiscard]] std::uint64_t violations() const noexcept;
    /// Violations of one kind.
    [[nodiscard]] std::uint64_t count(Violation kind) const noexcept;
    /// Name of the first function called that is not allowed; "" when there is none.
    [[nodiscard]] const char* first() const noexcept;
    /// Times that the thread gave up its processor of its own accord (blocked) between begin() and end().
    [[nodiscard]] std::int64_t context_switches() const noexcept { return context_switches_; }

    /// False under AddressSanitizer and ThreadSanitizer, which replace these functions themselves: nothing is
    /// trapped there.
    [[nodiscard]] static bool traps() noexcept;

    /// Lets a device call of the guarded thread through while it lives.
    class DeviceCall {
      public:
        DeviceCall() noexcept;
        ~DeviceCall();
        DeviceCall(const DeviceCall&) = delete;
        DeviceCall& operator=(const DeviceCall&) = delete;
    };

    /// For the replaced functions: books a call of the guarded thread. Allocates nothing, keeps errno.
    void note(Violation kind, const char* function) noexcept;
    /// For the replaced functions: books a call of the calling thread, when it is guarded.
    static void note_here(Violation kind, const char* function) noexcept;
    /// For the replaced functions: clock_nanosleep, allowed or not.
    static void note_clock_nanosleep() noexcept;

  private:
    Allowed allowed_;
    std::array<std::atomic<std::uint64_t>, k_violations> counts_{};
    std::atomic<const char*> first_{""};
    std::int64_t context_switches_{0};
};

} // namespace haptics::testing
