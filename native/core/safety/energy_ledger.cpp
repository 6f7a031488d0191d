// With F constant between samples, the integral of F . dx is F_k . (x_{k+1} - x_k) exactly, whatever the path
// between them: the ledger has no discretization error of its own. It sees positions as measured, hence is
// uncertain by |F| times one encoder step.

#include <haptics/core/safety/energy_ledger.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

void EnergyLedger::reset(const Pose& pose, double stored) {
    *this = EnergyLedger{};
    if (pose.allFinite())
        pose_ = pose;
    if (std::isfinite(stored))
        stored_start_ = stored;
}

void EnergyLedger::set_force(const Wrench& applied) {
    if (applied.allFinite())
        force_ = applied;
    else
        ++ignored_;
}

void EnergyLedger::book(const Pose& pose, double stored, double source_work) {
    if (!pose.allFinite() || !std::isfinite(stored) || !std::isfinite(source_work)) {
        ++ignored_;
        return;
    }
    delivered_ += force_.dot(pose - pose_);
    pose_ = pose;
    sources_ += source_work;
    created_ = delivered_ + (stored - stored_start_) - sources_;
    peak_ = std::max(peak_, created_);
    lowest_ = std::min(lowest_, created_);
    gain_ = std::max(gain_, created_ - lowest_);
}

} // namespace haptics
