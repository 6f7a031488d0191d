#pragma once
/// A device made of the reference firmware and a simulated pantograph, seen by the real hidapi through
/// hidraw_preload.c.

#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <haptics_firmware/firmware.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptics::testing {

struct EmulatedDeviceOptions {
    int vendor{0x1209};
    int product{0x0001};
    std::string serial{"E-001"};
    PantographGeometry geometry{ubc_twin_pantograph()};
    SimulatedHandOptions hand{};
    /// Encoders that know their zero; otherwise the device wakes up without one.
    bool absolute{true};
    bool measures_force{true};
};

/// Who sets the pace of the device's clock.
enum class Pace {
    real_time, ///< a report a millisecond, whatever the host does
    with_host, ///< the same, but the clock stands while the host is more than k_ahead reports behind
};

class EmulatedDevice {
  public:
    /// Reports that the device gets ahead of the host before its clock stands (Pace::with_host).
    static constexpr std::uint32_t k_ahead = 16;
    using Bytes = std::vector<std::uint8_t>;

    /// Unplugged. `name` is its node's, for messages.
    explicit EmulatedDevice(const EmulatedDeviceOptions& options, std::string name = "hidraw9000");
    ~EmulatedDevice();
    EmulatedDevice(const EmulatedDevice&) = delete;
    EmulatedDevice& operator=(const EmulatedDevice&) = delete;

    /// Power-on: the firmware starts afresh, and hidapi can find it.
    void plug();
    /// All connections end.
    void unplug();
    /// Opening it fails for lack of permission, or no more.
    void deny(bool denied);

    /// One millisecond by hand: motors, mechanics, encoders, one report to every open file. Not while run().
    void tick();
    /// A clock for hosts that are stepped by hand too: a millisecond for each tick of any device, ns.
    static std::int64_t hand_clock_ns() noexcept { return hand_clock_ns_.load(); }
    /// Ticks on a thread of its own until stop().
    void run(Pace pace);
    void stop();

    /// Whatever is to happen to a report on its way: takes the packet, gives those that are sent instead.
    void set_way(std::function<std::vector<Bytes>(const Bytes&)> way);
    /// Changes what the board measured before the firmware sees it.
    void set_board(std::function<void(haptics_sample&)> board);
    /// Changes a feature report before the host gets it.
    void set_features(std::function<void(Bytes&)> features);
    /// Commands wait in the queue, as with a device that hangs.
    void set_deaf(bool deaf) { deaf_ = deaf; }

    /// Waits until that many commands were taken; false after 10 s.
    bool wait_for_commands(std::uint64_t count);

    /// What the host sent and the device saw.
    struct Books {
        std::uint64_t reports{0};       ///< reports made
        std::uint64_t dropped{0};       ///< of these, not fitting into the queue of the file that only reads
        std::uint64_t commands{0};      ///< taken
        std::uint64_t refused{0};       ///< not taken
        std::uint64_t command_gaps{0};  ///< sequence numbers between taken commands that never came
        std::uint64_t held_up{0};       ///< times that the clock stood for the host
        std::uint64_t enabled_ticks{0}; ///< milliseconds with motors on
    };
    [[nodiscard]] Books books();
    /// Torques that the motors follow now, uN m.
    [[nodiscard]] std::array<std::int32_t, HAPTICS_AXES> torques();
    /// The mechanics, to look at or place; take the lock while a thread runs.
    SimulatedPantograph& mechanics() { return mechanics_; }
    std::mutex& mutex() { return mutex_; }
    haptics_firmware& firmware() { return firmware_; }

  private:
    struct File {
        int connection{-1};
        bool writes{false};
        std::uint64_t dropped{0};
    };
    void write_registry();
    void serve();
    void accept_file();
    void answer_feature();
    bool take_command(File& file);
    void send_report();
    void measure(haptics_sample& sample);
    void apply_motors();
    void tick_locked();

    static inline std::atomic<std::int64_t> hand_clock_ns_{0};

    EmulatedDeviceOptions options_;
    std::string folder_;
    SimulatedPantograph mechanics_;
    haptics_identity identity_{};
    haptics_calibration calibration_{};
    haptics_firmware firmware_{};
    std::array<std::int32_t, HAPTICS_AXES> count_at_power_on_{};
    std::uint32_t clock_us_{4294000000U}; // wraps after a second
    std::array<std::int32_t, HAPTICS_AXES> torque_{};
    std::uint32_t answered_{0};
    std::uint32_t last_command_{0};
    bool has_command_{false};
    Books books_;
    std::function<std::vector<Bytes>(const Bytes&)> way_;
    std::function<void(haptics_sample&)> board_;
    std::function<void(Bytes&)> features_;
    std::atomic<bool> deaf_{false};

    std::mutex mutex_;
    std::condition_variable commanded_;
    std::vector<File> files_;
    int reports_socket_{-1};
    int features_socket_{-1};
    std::atomic<bool> serving_{false};
    std::atomic<bool> ticking_{false};
    std::thread server_;
    std::thread ticker_;
};

} // namespace haptics::testing
