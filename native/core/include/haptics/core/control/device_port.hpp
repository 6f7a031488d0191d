#pragma once
/// What the haptic step needs of a device, real or simulated.

#include <haptics/core/pantograph/kinematics.hpp>
#include <haptics/core/safety/fault.hpp>
#include <haptics/core/types.hpp>

#include <cstdint>

namespace haptics {

/// One reading of the device, in the device's own frame (m, rad, N, s).
struct DeviceReading {
    /// Handle pose as the encoders give it (theta 0 when the device has two freedoms).
    Pose pose{0.0, 0.0, 0.0};
    /// Joint angles as the encoders give them, rad, when the device has encoders at its joints: they let the
    /// loop see an encoder slip.
    JointVector angles{JointVector::Zero()};
    bool has_angles{false};
    /// Handle velocity when the device measures it, otherwise see has_velocity.
    Twist velocity{0.0, 0.0, 0.0};
    bool has_velocity{false};
    /// Force of the hand on the handle when the device measures it.
    Wrench hand_force{0.0, 0.0, 0.0};
    bool has_hand_force{false};
    /// Buttons, bit i is button i.
    std::uint32_t buttons{0};
    /// Grows by one with every new sample; unchanged means that the sample is the last one again.
    std::uint64_t sequence{0};
    /// Time between this sample and the one before on the device's clock, s; 0 when the device has no clock,
    /// and the steps of the loop count instead.
    double interval{0.0};
    /// How old the sample is beyond the delay that every sample has, s: the handle has moved on by velocity
    /// times age since. 0 when unknown.
    double age{0.0};
    /// The device knows its zero; while it does not, the pose means nothing and no force may come.
    bool homed{true};
    /// Changes each time the device finds its zero (again): what was known of its encoders before means
    /// nothing then.
    std::uint32_t homings{0};
    /// What the device or its driver found wrong in this step.
    Fault faults{Fault::none};
};

/// A device seen from the haptic loop. Neither call allocates, locks, logs or throws; neither blocks longer
/// than the device needs.
class DevicePort {
  public:
    virtual ~DevicePort() = default;
    DevicePort() = default;
    DevicePort(const DevicePort&) = delete;
    DevicePort& operator=(const DevicePort&) = delete;

    /// Takes the newest sample. False when there is none (unplugged, late): `reading` is then left as it was.
    virtual bool read(DeviceReading& reading) = 0;
    /// Commands a force at the handle (N, N, N m; device frame). Comes straight from the output gate.
    virtual void write(const Wrench& force) = 0;
    /// Lets simulated devices pass the time between two steps (s); real ones do nothing.
    virtual void advance(double /*dt*/) {}
    /// Effective mass matrix at the handle for the given pose, kg, kg m^2.
    [[nodiscard]] virtual Mat3 handle_mass(const Pose& pose) const = 0;
    /// 2 or 3.
    [[nodiscard]] virtual int freedoms() const = 0;
};

} // namespace haptics
