#pragma once
/// What a pantograph needs whatever the scene: its encoders watched, its own weight, friction and inertia
/// taken off the hand.

#include <haptics/core/control/device_port.hpp>
#include <haptics/core/pantograph/compensation.hpp>
#include <haptics/core/safety/encoder_check.hpp>
#include <haptics/core/safety/output_gate.hpp>

#include <optional>

namespace haptics {

struct DeviceCareSettings {
    /// Off unless something in it is set.
    CompensationSettings compensation{};
    /// Watches the encoders of devices that give their joint angles.
    bool check_encoders{true};
    EncoderCheckSettings encoders{};
};

/// Every setting out of range, or impossible with the geometry. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const DeviceCareSettings& settings, const PantographGeometry& geometry);

/// Does both for one session. All its forces go through the gate with the controller's. Loop thread only;
/// nothing allocates but the constructor.
class DeviceCare {
  public:
    /// Without kinematics in the gate it does nothing. `reading_error`: as in SessionSettings.
    DeviceCare(const DeviceCareSettings& settings, const OutputGate& gate, const Vec3& reading_error);

    /// A new sample of the device, `dt` s after the last.
    void take(const DeviceReading& reading, double dt);
    /// Fault::home_the_device_again from a slip on until homed().
    [[nodiscard]] Fault fault() const;
    /// The wrench to add to the command (N, N, N m, device frame).
    [[nodiscard]] const Wrench& wrench() const { return wrench_; }
    /// What the gate made of `command`, in which wrench() was.
    void sent(const Wrench& command, const Wrench& applied);
    /// The part of the last applied wrench that was the compensation's.
    [[nodiscard]] Wrench applied() const { return passed_ * wrench_; }
    /// The device was away: the next sample begins anew. A slip stays.
    void restart();
    /// The device was homed: forgets what the encoders said before, a slip too.
    void homed();

    /// Null without kinematics, or switched off.
    [[nodiscard]] const EncoderCheck* encoders() const { return check_ ? &*check_ : nullptr; }
    [[nodiscard]] const Compensation* compensation() const {
        return compensation_ ? &*compensation_ : nullptr;
    }

  private:
    std::optional<PantographKinematics> kinematics_;
    std::optional<Compensation> compensation_;
    std::optional<EncoderCheck> check_;
    Wrench wrench_{0.0, 0.0, 0.0};
    double passed_{0.0};
};

} // namespace haptics
