#pragma once
/// Whether another engine computes the same motion: without that its time says nothing.

#include <haptics/peers/peers.hpp>

#include <cstdint>

namespace haptics::peers {

struct Agreement {
    /// Largest difference of joint accelerations over random states, as a part of the largest acceleration;
    /// < 0 when the engine does not tell them.
    double acceleration{-1.0};
    /// Distance between the two tips after a run, as a part of the length of the tip's path.
    double motion{0.0};
    bool holds{false};
};

/// Compares `peer` with ours on `spec` (see plan_of): accelerations at `states` random states, and the run
/// that `demand` names from another one.
[[nodiscard]] Agreement compare(ChainPeer& peer, const LinkageSpec& spec, const AgreementDemand& demand,
                                int states, std::uint64_t seed);

} // namespace haptics::peers
