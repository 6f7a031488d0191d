#include <haptics/core/control/impulse_channel.hpp>

#include <algorithm>

namespace haptics {

void ImpulseChannel::demand(const Wrench& impulse) {
    demanded_ += impulse;
    pending_ += impulse;
    time_left_ = k_spread;
}

Wrench ImpulseChannel::deliver(double dt, double max_force, double max_torque) {
    if (pending_.isZero(0.0))
        return Wrench::Zero();
    if (time_left_ <= 0.0) {
        drop();
        return Wrench::Zero();
    }
    const double force = pending_.head<2>().norm() / dt;
    const double torque = std::abs(pending_.z()) / dt;
    const double scale = std::min({1.0, std::max(max_force, 0.0) / std::max(force, 1e-300),
                                   std::max(max_torque, 0.0) / std::max(torque, 1e-300)});
    const Wrench now = scale * pending_;
    delivered_ += now;
    pending_ -= now;
    if (scale >= 1.0)
        pending_.setZero();
    time_left_ -= dt;
    return now / dt;
}

void ImpulseChannel::drop() {
    dropped_ += pending_;
    pending_.setZero();
    time_left_ = 0.0;
}

} // namespace haptics
