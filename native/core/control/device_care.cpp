#include <haptics/core/control/device_care.hpp>

#include <algorithm>

namespace haptics {

std::vector<FigureError> validate(const DeviceCareSettings& settings, const PantographGeometry& geometry) {
    FigureCheck check;
    check.append(validate(settings.compensation, geometry));
    check.append(validate(settings.encoders));
    return check.take();
}

DeviceCare::DeviceCare(const DeviceCareSettings& settings, const OutputGate& gate, const Vec3& reading_error)
    : kinematics_(gate.kinematics()) {
    if (!kinematics_)
        return;
    if (settings.compensation.active())
        compensation_.emplace(*kinematics_, settings.compensation, reading_error);
    if (settings.check_encoders && kinematics_->freedoms() == 3)
        check_.emplace(*kinematics_, settings.encoders);
}

void DeviceCare::take(const DeviceReading& reading, double dt) {
    if (check_ && reading.has_angles)
        check_->update(reading.angles, kinematics_->forward(reading.angles), dt);
    if (compensation_)
        wrench_ = compensation_->update(reading.pose, reading.has_angles ? &reading.angles : nullptr, dt);
}

Fault DeviceCare::fault() const {
    return check_ && check_->slipped() ? Fault::home_the_device_again : Fault::none;
}

void DeviceCare::sent(const Wrench& command, const Wrench& applied) {
    if (!compensation_)
        return;
    const double size = command.squaredNorm();
    passed_ = size > 1.0e-18 ? std::clamp(applied.dot(command) / size, 0.0, 1.0) : 0.0;
    compensation_->passed(passed_);
}

void DeviceCare::restart() {
    if (compensation_)
        compensation_->reset();
    wrench_.setZero();
}

void DeviceCare::homed() {
    restart();
    if (check_)
        check_->reset();
}

} // namespace haptics
