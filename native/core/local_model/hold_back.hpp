#pragma once
// The part of a coupling that takes effect: the output gate's share, less what the device cannot answer with.

#include <haptics/core/local_model/local_model.hpp>

#include <algorithm>
#include <cmath>

namespace haptics::local {

// Given the coupling's force at full share.
inline double effective_share(const HandInput& hand, const Wrench& full) {
    // nearly always the device can: no root, no division
    const double used = hand.share * hand.share * full.head<2>().squaredNorm();
    if (used < 0.999 * hand.max_force * hand.max_force &&
        hand.share * std::abs(full.z()) < 0.999 * hand.max_torque)
        return hand.share;
    return std::min({hand.share, hand.max_force / std::max(full.head<2>().norm(), 1e-300),
                     hand.max_torque / std::max(std::abs(full.z()), 1e-300)});
}

} // namespace haptics::local
