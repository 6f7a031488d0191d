#pragma once

#include <haptics/binder/godot.hpp>

#include <atomic>
#include <thread>

/// Changes from build to build; the build makes its source.
extern const long
    probe_generation; // NOLINT(readability-identifier-naming): the reload test writes its definition

namespace haptics {

/// Test singleton with a running thread, as a loop has one: it must stop before the library goes.
class ProbeServer : public godot::Object {
    GDCLASS(ProbeServer, godot::Object)

  public:
    ProbeServer() { instance = this; }
    ~ProbeServer() override { instance = nullptr; }

    static ProbeServer* get_singleton() { return instance; }
    int64_t get_generation() const { return probe_generation; }
    int64_t get_frames() const { return frames; }
    int64_t get_startups() const { return startups; }
    int64_t get_beats() const { return beats.load(); }
    bool is_beating() const { return beating.load(); }

    /// Starts the thread and hangs itself into main loop and unloading.
    static void start();

  protected:
    static void _bind_methods();

  private:
    static inline ProbeServer* instance = nullptr;
    static inline int64_t frames = 0;
    static inline int64_t startups = 0;
    static inline std::atomic<int64_t> beats{0};
    static inline std::atomic<bool> beating{false};
};

} // namespace haptics
