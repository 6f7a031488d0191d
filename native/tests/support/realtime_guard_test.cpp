#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>

#include "support/realtime_guard.hpp"

using haptics::testing::RealtimeGuard;
using haptics::testing::Violation;

namespace {

// keeps the compiler from leaving out a call whose result nobody needs
void* volatile g_kept = nullptr;
// texts that the compiler knows nothing about, lest it picks another function
const char* volatile g_text = "xyz";
const char* volatile g_nothing = "";

// what a step must not do, under guard
template <typename Work>
void check_trapped(Violation kind, const std::string& name, Work work) {
    RealtimeGuard guard;
    guard.begin();
    work();
    guard.end();
    CAPTURE(name);
    CHECK(guard.count(kind) >= 1);
    CHECK(std::string(guard.first()) == name);
    // and without a guard the same work is nobody's business
    RealtimeGuard idle;
    work();
    CHECK(idle.violations() == 0);
}

} // namespace

TEST_SUITE("the real-time guard" * doctest::skip(!RealtimeGuard::traps())) {
    TEST_CASE("passes work that neither allocates, locks nor blocks") {
        RealtimeGuard guard;
        std::atomic<int> number{0};
        guard.begin();
        timespec now{};
        for (int i = 0; i < 1000; ++i) {
            number.fetch_add(1);
            clock_gettime(CLOCK_MONOTONIC, &now);
        }
        guard.end();
        CHECK(guard.violations() == 0);
        CHECK(std::string(guard.first()).empty());
    }

    TEST_CASE("traps memory taken and given back") {
        check_trapped(Violation::allocation, "malloc", [] {
            g_kept = std::malloc(8);
            std::free(g_kept);
        });
        check_trapped(Violation::allocation, "malloc", [] {
            const auto made = std::make_unique<int>(1);
            g_kept = made.get();
        });
        check_trapped(Violation::allocation, "calloc", [] {
            g_kept = std::calloc(1, 8);
            std::free(g_kept);
        });
        g_kept = nullptr;
        check_trapped(Violation::allocation, "realloc", [] {
            void* const nothing = g_kept;
            g_kept = std::realloc(nothing, 8);
            std::free(g_kept);
            g_kept = nullptr;
        });
        check_trapped(Violation::allocation, "malloc", [] {
            std::string text(100, 'x');
            g_kept = text.data();
        });
        int* volatile kept[2] = {new int(1), new int(2)};
        int next = 0;
        check_trapped(Violation::deallocation, "free", [&] { delete kept[next++]; });
    }

    TEST_CASE("traps locks") {
        std::mutex mutex;
        check_trapped(Violation::lock, "pthread_mutex_lock", [&] { const std::lock_guard lock(mutex); });
        std::shared_mutex shared;
        check_trapped(Violation::lock, "pthread_rwlock_wrlock", [&] { const std::unique_lock lock(shared); });
        check_trapped(Violation::lock, "pthread_rwlock_rdlock", [&] { const std::shared_lock lock(shared); });
        pthread_spinlock_t spin{};
        pthread_spin_init(&spin, 0);
        check_trapped(Violation::lock, "pthread_spin_lock", [&] {
            pthread_spin_lock(&spin);
            pthread_spin_unlock(&spin);
        });
        sem_t semaphore;
        sem_init(&semaphore, 0, 2);
        check_trapped(Violation::lock, "sem_wait", [&] { sem_wait(&semaphore); });
        sem_destroy(&semaphore);
    }

    TEST_CASE("traps waits for another thread") {
        std::mutex mutex;
        std::condition_variable condition;
        std::unique_lock lock(mutex);
        check_trapped(Violation::lock, "pthread_cond_clockwait",
                      [&] { condition.wait_for(lock, std::chrono::milliseconds(1)); });

        // a waiter that somebody else wakes, so that pthread_cond_wait comes back
        bool done = false;
        std::thread other([&] {
            for (;;) {
                const std::lock_guard inner(mutex);
                if (done) {
                    return;
                }
                condition.notify_all();
            }
        });
        check_trapped(Violation::lock, "pthread_cond_wait", [&] { condition.wait(lock); });
        done = true;
        lock.unlock();
        other.join();

        std::atomic<int> flag{0};
        std::thread setter;
        setter = std::thread([&flag] {
            const timespec time{0, 20000000};
            nanosleep(&time, nullptr);
            flag = 1;
            flag.notify_all();
        });
        RealtimeGuard guard;
        guard.begin();
        flag.wait(0);
        guard.end();
        setter.join();
        CHECK(guard.violations() > 0);
    }

    TEST_CASE("traps sleeps") {
        const timespec brief{0, 1000};
        check_trapped(Violation::sleep, "nanosleep", [&] { nanosleep(&brief, nullptr); });
        check_trapped(Violation::sleep, "nanosleep",
                      [] { std::this_thread::sleep_for(std::chrono::microseconds(1)); });
        check_trapped(Violation::sleep, "usleep", [] { usleep(1); });
        check_trapped(Violation::sleep, "clock_nanosleep",
                      [&] { clock_nanosleep(CLOCK_MONOTONIC, 0, &brief, nullptr); });
        check_trapped(Violation::sleep, "sched_yield", [] { sched_yield(); });
        check_trapped(Violation::sleep, "poll", [] { poll(nullptr, 0, 1); });
    }

    TEST_CASE("traps files") {
        check_trapped(Violation::file, "open", [] { close(open("/dev/null", O_RDONLY | O_CLOEXEC)); });
        const int file = open("/dev/null", O_RDWR | O_CLOEXEC);
        char byte = 0;
        ssize_t got = -1;
        check_trapped(Violation::file, "read", [&] { got = read(file, &byte, 1); });
        check_trapped(Violation::file, "write", [&] { got = write(file, &byte, 1); });
        CHECK(got == 1);
        int waiting = 0;
        check_trapped(Violation::file, "ioctl", [&] { ioctl(file, FIONREAD, &waiting); });
        close(file);
        check_trapped(Violation::file, "fopen", [] { std::fclose(std::fopen("/dev/null", "re")); });
        check_trapped(Violation::file, "mmap", [] {
            g_kept = mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            munmap(g_kept, 4096);
        });
        RealtimeGuard guard;
        guard.begin();
        {
            const std::ifstream stream("/dev/null");
        }
        guard.end();
        CHECK(guard.count(Violation::file) > 0);
    }

    TEST_CASE("traps prints") {
        std::FILE* const file = std::fopen("/dev/null", "we");
        check_trapped(Violation::print, "vfprintf", [&] { std::fprintf(file, "%d", 1); });
        check_trapped(Violation::print, "fputs", [&] { std::fputs(g_text, file); });
        check_trapped(Violation::print, "fwrite", [&] { std::fwrite("xy", 1, 2, file); });
        check_trapped(Violation::print, "fflush", [&] { std::fflush(file); });
        std::fclose(file);
        check_trapped(Violation::print, "vprintf", [] { std::printf("%s", g_nothing); });
        std::ofstream stream("/dev/null");
        RealtimeGuard guard;
        guard.begin();
        stream << "x" << std::flush;
        guard.end();
        CHECK(guard.count(Violation::file) > 0);
    }

    TEST_CASE("traps threads being made and joined") {
        std::thread other;
        RealtimeGuard guard;
        guard.begin();
        other = std::thread([] {});
        other.join();
        guard.end();
        CHECK(guard.count(Violation::thread) == 2);
    }

    TEST_CASE("sees only its own thread, lets allowed calls through, and counts blocking it cannot name") {
        RealtimeGuard guard;
        std::thread other([] {
            for (int i = 0; i < 100; ++i) {
                const auto made = std::make_unique<int>(i);
                g_kept = made.get();
            }
        });
        const timespec brief{0, 1000000};
        guard.begin({.clock_nanosleep = true});
        clock_nanosleep(CLOCK_MONOTONIC, 0, &brief, nullptr);
        {
            const RealtimeGuard::DeviceCall device;
            nanosleep(&brief, nullptr);
        }
        guard.end();
        CHECK(guard.violations() == 0);
        CHECK(guard.context_switches() >= 2);
        other.join();
    }
}
