// Replaces the functions of the C library that a haptic step must not call. Each books the call with the
// thread's guard, when there is one, and hands on to the C library's own. The definitions here win over the C
// library's for the program and the shared libraries it loads; calls within the C library itself do not pass
// here.

// the C library's inline variants, checked or not, would clash with these
#undef _FORTIFY_SOURCE
#ifndef __NO_INLINE__
#define __NO_INLINE__ 1 // NOLINT(bugprone-reserved-identifier)
#endif

#include "support/realtime_guard.hpp"
#include "support/sanitizers.hpp"

#if HAPTICS_TESTS_REPLACE_MALLOC

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>

namespace {

using haptics::testing::RealtimeGuard;
using haptics::testing::Violation;

// the C library's own function, looked up once; a race looks it up twice
template <typename Function>
class Original {
  public:
    constexpr explicit Original(const char* name)
        : name_(name) {}

    Function* get() noexcept {
        Function* found = function_.load(std::memory_order_relaxed);
        if (found == nullptr) {
            found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name_));
            function_.store(found, std::memory_order_relaxed);
        }
        return found;
    }

  private:
    const char* name_;
    std::atomic<Function*> function_{nullptr};
};

} // namespace

// NOLINTBEGIN(bugprone-macro-parentheses): parameters and arguments bring their parentheses
#define HAPTICS_TRAP_AS(kind, exceptions, result, name, parameters, arguments)                               \
    result name parameters exceptions {                                                                      \
        static constinit Original<result parameters> own{#name};                                             \
        RealtimeGuard::note_here(Violation::kind, #name);                                                    \
        return own.get() arguments;                                                                          \
    }
#define HAPTICS_TRAP(kind, result, name, parameters, arguments)                                              \
    HAPTICS_TRAP_AS(kind, , result, name, parameters, arguments)
#define HAPTICS_TRAP_NOEXCEPT(kind, result, name, parameters, arguments)                                     \
    HAPTICS_TRAP_AS(kind, noexcept, result, name, parameters, arguments)
// NOLINTEND(bugprone-macro-parentheses)

// clang-format off
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): the C library names them __like_this
#pragma GCC visibility push(default)
extern "C" {

// locks and waits
HAPTICS_TRAP_NOEXCEPT(lock, int, pthread_mutex_lock, (pthread_mutex_t* mutex), (mutex))
HAPTICS_TRAP_NOEXCEPT(lock, int, pthread_mutex_timedlock, (pthread_mutex_t* mutex, const timespec* until), (mutex, until))
HAPTICS_TRAP_NOEXCEPT(lock, int, pthread_rwlock_rdlock, (pthread_rwlock_t* lock), (lock))
HAPTICS_TRAP_NOEXCEPT(lock, int, pthread_rwlock_wrlock, (pthread_rwlock_t* lock), (lock))
HAPTICS_TRAP_NOEXCEPT(lock, int, pthread_spin_lock, (pthread_spinlock_t* lock), (lock))
HAPTICS_TRAP(lock, int, pthread_cond_wait, (pthread_cond_t* condition, pthread_mutex_t* mutex), (condition, mutex))
HAPTICS_TRAP(lock, int, pthread_cond_timedwait, (pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until), (condition, mutex, until))
HAPTICS_TRAP(lock, int, pthread_cond_clockwait, (pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until), (condition, mutex, clock, until))
HAPTICS_TRAP(lock, int, sem_wait, (sem_t* semaphore), (semaphore))
HAPTICS_TRAP(lock, int, sem_timedwait, (sem_t* semaphore, const timespec* until), (semaphore, until))

// sleeps
HAPTICS_TRAP(sleep, int, nanosleep, (const timespec* time, timespec* left), (time, left))
HAPTICS_TRAP(sleep, int, usleep, (useconds_t time), (time))
HAPTICS_TRAP(sleep, unsigned, sleep, (unsigned time), (time))
HAPTICS_TRAP(sleep, int, poll, (pollfd* files, nfds_t count, int timeout), (files, count, timeout))
HAPTICS_TRAP(sleep, int, select, (int count, fd_set* in, fd_set* out, fd_set* error, timeval* timeout), (count, in, out, error, timeout))
HAPTICS_TRAP(sleep, int, epoll_wait, (int file, epoll_event* events, int count, int timeout), (file, events, count, timeout))
HAPTICS_TRAP_NOEXCEPT(sleep, int, sched_yield, (), ())

// files
HAPTICS_TRAP(file, ssize_t, read, (int file, void* data, size_t size), (file, data, size))
HAPTICS_TRAP(file, ssize_t, write, (int file, const void* data, size_t size), (file, data, size))
HAPTICS_TRAP(file, ssize_t, writev, (int file, const iovec* parts, int count), (file, parts, count))
HAPTICS_TRAP(file, int, close, (int file), (file))
HAPTICS_TRAP(file, int, fsync, (int file), (file))
HAPTICS_TRAP(file, FILE*, fopen, (const char* path, const char* mode), (path, mode))
HAPTICS_TRAP(file, FILE*, fopen64, (const char* path, const char* mode), (path, mode))
HAPTICS_TRAP(file, int, fclose, (FILE* file), (file))
HAPTICS_TRAP(file, size_t, fread, (void* data, size_t size, size_t count, FILE* file), (data, size, count, file))
HAPTICS_TRAP_NOEXCEPT(file, void*, mmap, (void* at, size_t size, int protection, int flags, int file, off_t offset), (at, size, protection, flags, file, offset))
HAPTICS_TRAP_NOEXCEPT(file, int, munmap, (void* at, size_t size), (at, size))
HAPTICS_TRAP_NOEXCEPT(file, void*, dlopen, (const char* path, int mode), (path, mode))

// prints
HAPTICS_TRAP(print, int, vprintf, (const char* format, va_list values), (format, values))
HAPTICS_TRAP(print, int, vfprintf, (FILE* file, const char* format, va_list values), (file, format, values))
HAPTICS_TRAP(print, int, puts, (const char* text), (text))
HAPTICS_TRAP(print, int, fputs, (const char* text, FILE* file), (text, file))
HAPTICS_TRAP(print, int, fputc, (int character, FILE* file), (character, file))
HAPTICS_TRAP(print, int, putc, (int character, FILE* file), (character, file))
HAPTICS_TRAP(print, int, putchar, (int character), (character))
HAPTICS_TRAP(print, size_t, fwrite, (const void* data, size_t size, size_t count, FILE* file), (data, size, count, file))
HAPTICS_TRAP(print, int, fflush, (FILE* file), (file))

// threads
HAPTICS_TRAP_NOEXCEPT(thread, int, pthread_create, (pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*), void* data), (thread, attributes, work, data))
HAPTICS_TRAP(thread, int, pthread_join, (pthread_t thread, void** result), (thread, result))
// clang-format on

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
    static constinit Original<int(clockid_t, int, const timespec*, timespec*)> own{"clock_nanosleep"};
    RealtimeGuard::note_clock_nanosleep();
    return own.get()(clock, flags, time, left);
}

int open(const char* path, int flags, ...) {
    static constinit Original<int(const char*, int, ...)> own{"open"};
    RealtimeGuard::note_here(Violation::file, "open");
    va_list values;
    va_start(values, flags);
    const auto mode = va_arg(values, mode_t);
    va_end(values);
    return own.get()(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
    static constinit Original<int(int, const char*, int, ...)> own{"openat"};
    RealtimeGuard::note_here(Violation::file, "openat");
    va_list values;
    va_start(values, flags);
    const auto mode = va_arg(values, mode_t);
    va_end(values);
    return own.get()(folder, path, flags, mode);
}

int ioctl(int file, unsigned long request, ...) noexcept {
    static constinit Original<int(int, unsigned long, ...)> own{"ioctl"};
    RealtimeGuard::note_here(Violation::file, "ioctl");
    va_list values;
    va_start(values, request);
    void* const data = va_arg(values, void*);
    va_end(values);
    return own.get()(file, request, data);
}

int printf(const char* format, ...) {
    va_list values;
    va_start(values, format);
    const int written = vprintf(format, values);
    va_end(values);
    return written;
}

int fprintf(FILE* file, const char* format, ...) {
    va_list values;
    va_start(values, format);
    const int written = vfprintf(file, format, values);
    va_end(values);
    return written;
}

// how std::atomic waits
long syscall(long number, ...) noexcept {
    static constinit Original<long(long, ...)> own{"syscall"};
    if (number == SYS_futex) {
        RealtimeGuard::note_here(Violation::lock, "futex");
    }
    va_list values;
    va_start(values, number);
    const long a = va_arg(values, long);
    const long b = va_arg(values, long);
    const long c = va_arg(values, long);
    const long d = va_arg(values, long);
    const long e = va_arg(values, long);
    const long f = va_arg(values, long);
    va_end(values);
    return own.get()(number, a, b, c, d, e, f);
}
}
#pragma GCC visibility pop
// NOLINTEND(readability-inconsistent-declaration-parameter-name)

#endif
