#pragma once
/// A planar pantograph on USB HID, seen from the haptic loop.

#include <haptics/core/control/device_port.hpp>
#include <haptics/core/pantograph/kinematics.hpp>
#include <haptics/devices/hid/hid_options.hpp>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptics {

class HidLink;

/// The driver. The loop reads what has come and leaves the newest command, and never waits for the device: a
/// writer thread hands commands to the system, and a supervisor thread closes a lost connection and opens the
/// next one.
///
/// After an unplug the reading fails until the device is back; it then has lost its zero, so `homed` in the
/// readings is false until it was homed, and no force comes before an explicit re-arm.
class HidPantograph final : public DevicePort {
  public:
    /// Opens the device: loads hidapi, finds, opens and questions it. Null, and `error` says why and what to
    /// do. Allocates, blocks; not for the loop.
    static std::unique_ptr<HidPantograph> open(const HidPantographOptions& options, std::string& error);
    /// Lets the motors go, ends both threads, closes. The loop has ended before.
    ~HidPantograph() override;

    // the loop's side
    bool read(DeviceReading& reading) override;
    void write(const Wrench& force) override;
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override;
    [[nodiscard]] int freedoms() const override { return kinematics_.freedoms(); }
    /// Loop side, or no loop running: what became of the reports so far.
    [[nodiscard]] const HidCounts& counts() const { return stream_.counts(); }

    // the owner's side
    /// The linkage with the device's own offsets, gears, limits and home; for the gate.
    [[nodiscard]] const PantographKinematics& kinematics() const { return kinematics_; }
    /// Largest error of a reading per coordinate, for the velocity estimate: half a count seen at the handle.
    [[nodiscard]] Vec3 reading_error() const;
    /// From report to report, s; one more passes until a report is here and its command there.
    [[nodiscard]] double interval() const;
    /// What the device is.
    [[nodiscard]] const HidIdentity& identity() const { return identity_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Tells the device that its handle is in the home pose. Waits for the answer, at most a second; empty
    /// when it was done, else what to do.
    std::string home_here();
    /// What happened to the connection since the last call, for a person to read.
    std::vector<std::string> take_messages();

    // any thread
    /// The device is plugged in and opened.
    [[nodiscard]] bool is_connected() const { return connected_.load(std::memory_order_relaxed); }
    /// Newest copy of counts().
    [[nodiscard]] HidCounts published_counts() const;
    /// Commands handed to the system; commands that a newer one overtook before that; connections so far.
    [[nodiscard]] std::uint64_t commands_sent() const;
    [[nodiscard]] std::uint64_t commands_overtaken() const;
    [[nodiscard]] std::uint64_t connections() const { return connections_.load(std::memory_order_relaxed); }

  private:
    HidPantograph(const HidPantographOptions& options, const PantographGeometry& geometry,
                  std::unique_ptr<HidLink> link);

    // loop
    [[nodiscard]] bool take_link();
    void hand_back();
    bool drain(std::int64_t now_ns);
    bool place(const HidSample& sample);
    void judge_status(const HidSample& sample);
    void publish_counts();

    // supervisor
    void supervise();
    void close_lost_link(std::unique_lock<std::mutex>& lock);
    void try_again(std::unique_lock<std::mutex>& lock);
    void answer_home();

    HidPantographOptions options_;
    PantographKinematics kinematics_;
    HidIdentity identity_;
    HidCalibration calibration_;
    std::string name_;

    // between loop and supervisor
    std::atomic<HidLink*> offered_{nullptr};
    std::atomic<HidLink*> handed_back_{nullptr};
    std::atomic<bool> connected_{true};
    std::atomic<std::uint64_t> connections_{1};
    std::atomic<std::uint64_t> sent_before_{0};
    std::atomic<std::uint64_t> overtaken_before_{0};
    // counts() for other threads
    std::array<std::atomic<std::uint64_t>, 11> published_{};

    // loop only
    HidLink* link_{nullptr};
    HidStream stream_;
    HidSample sample_;
    PantographState state_;
    DeviceReading reading_;
    std::int64_t heard_ns_{0};
    std::int64_t now_ns_{0};
    std::int64_t enabled_until_ns_{0};
    std::int64_t enabled_since_ns_{0};
    bool release_{true};
    bool was_let_go_{true};

    // supervisor and owner
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable answered_;
    std::unique_ptr<HidLink> current_;
    std::vector<std::string> messages_;
    std::string last_problem_;
    enum class Home : std::uint8_t { idle, asked, done, refused, away } home_{Home::idle};
    bool ending_{false};
    std::thread thread_;
};

} // namespace haptics
