#pragma once
/// One open connection to a device: its handles, what it is, and the thread that writes to it.

#include <haptics/devices/hid/hid_options.hpp>
#include <haptics/realtime/latest_value.hpp>

#include <semaphore.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hid/hid_library.hpp"

namespace haptics {

/// From counts to joint angles and from joint torques to what the device is told.
struct HidAxisMap {
    std::size_t axes{0};
    std::array<double, k_hid_axes> offset{};         ///< rad
    std::array<double, k_hid_axes> radian{};         ///< rad per count, signed
    std::array<double, k_hid_axes> counts_per_rad{}; ///< > 0
    std::array<double, k_hid_axes> micro_torque{};   ///< uN m at the motor per N m at the joint
    std::array<double, k_hid_axes> limit{};          ///< uN m at the motor
};

/// Made and destroyed off the loop. The kernel lets a write wait until the device takes it (a USB frame, or
/// longer when it hangs), so a thread of its own writes; the loop only leaves the newest command.
class HidLink {
  public:
    /// Finds, opens and questions the device. Null, and `error` says why and what to do.
    static std::unique_ptr<HidLink> open(const HidPantographOptions& options, std::string& error);
    /// Tells the device to let its motors go, ends the writer and closes.
    ~HidLink();
    HidLink(const HidLink&) = delete;
    HidLink& operator=(const HidLink&) = delete;

    /// Loop thread: reads one waiting report. Bytes read, 0 for none, -1 when the device is gone.
    int read(std::span<std::uint8_t> bytes) noexcept;
    /// Loop thread: leaves a command for the writer; its `sequence` is given there. Wait-free but for the
    /// wake-up of the writer.
    void post(const HidCommand& command) noexcept;
    /// Any thread: the device is gone, seen by reader or writer.
    [[nodiscard]] bool is_broken() const noexcept { return broken_.load(std::memory_order_relaxed); }
    /// Any thread: commands handed to the system, and commands that a newer one overtook before.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t overtaken() const noexcept { return commands_.dropped(); }

    /// Not the loop: asks for HAPTICS_ACTION_*. True when the device did it.
    bool act(std::uint8_t action);

    [[nodiscard]] const HidIdentity& identity() const { return identity_; }
    [[nodiscard]] const HidCalibration& calibration() const { return calibration_; }
    [[nodiscard]] const HidAxisMap& map() const { return map_; }
    /// "Name 1209:0001, serial X".
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    HidLink();
    bool open_handles(const HidPantographOptions& options, std::string& error);
    bool question(const HidPantographOptions& options, std::string& error);
    void write_commands(int priority) noexcept;
    bool write(HidCommand command) noexcept;

    std::shared_ptr<HidLibrary> library_;
    // hidapi's devices are for one thread each; where a back end opens only once they are the same
    hid_device* reader_{nullptr};
    hid_device* writer_{nullptr};
    std::string path_;
    HidIdentity identity_;
    HidCalibration calibration_;
    HidAxisMap map_;
    std::string name_;
    LatestValue<HidCommand> commands_;
    sem_t posted_{};
    std::atomic<bool> ending_{false};
    std::atomic<bool> broken_{false};
    std::atomic<std::uint64_t> sent_{0};
    std::uint32_t sequence_{0};
    std::thread thread_;
};

} // namespace haptics
