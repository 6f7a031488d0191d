#pragma once
/// Benchmarks of other engines.

#include <haptics/peers/peers.hpp>

namespace haptics::bench {

/// Time step of every chain, ours and theirs, s. Short, so that a chain without friction keeps its energy for
/// as long as it is timed.
inline constexpr double k_chain_time_step = 1e-5;

/// Adds `peer_<name>/links:n`.
void register_peer(const peers::Peer& peer);

} // namespace haptics::bench
