// With E the energy created so far (EnergyLedger), what it grows by until a force sent now acts added to it,
// and what may be an error of reading, e = sum |F|max q, taken off it, a damper -g M v takes g v.Mv T in the
// step; g = (E - e) / (T v.Mv) takes all of the rest at once. g T is the share of the momentum that goes: at
// most k_most, and none from a handle that hardly moves, whose velocity is noise. What remains is taken in
// the next steps; the ledger books what the gate let through.

#include <haptics/core/safety/passivity_controller.hpp>

#include <algorithm>

namespace haptics {

PassivityController::PassivityController(const Vec3& reading_error, double slack)
    : quantum_(2.0 * reading_error.cwiseMax(0.0))
    , slack_(std::max(slack, 0.0)) {}

Wrench PassivityController::damp(double created, const Wrench& force, const Twist& twist, const Mat3& mass,
                                 double step) {
    most_ = most_.cwiseMax(force.cwiseAbs());
    rise_ = known_ ? rise_ + (created - last_ - rise_) / k_mean : 0.0;
    last_ = created;
    known_ = true;
    const double excess = created + k_ahead * std::max(rise_, 0.0) - most_.dot(quantum_) - slack_;
    const Wrench momentum = mass * twist;
    const double twice_kinetic = twist.dot(momentum);
    // one quantum a step is no velocity
    const Twist noise = quantum_ / step;
    if (!(excess > 0.0) || !(twice_kinetic > 0.25 * noise.dot(mass * noise)))
        return Wrench::Zero();
    const double share = std::min(excess / twice_kinetic, k_most);
    taken_ += share * twice_kinetic;
    return -share / step * momentum;
}

} // namespace haptics
