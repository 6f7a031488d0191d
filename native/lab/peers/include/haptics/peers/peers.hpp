#pragma once
/// The other engines of this build, and those that are missing with the reason.

#include <haptics/core/dynamics/linkage_spec.hpp>
#include <haptics/peers/chain_peer.hpp>

#include <string>
#include <vector>

namespace haptics::peers {

/// How closely a peer has to repeat our motion before its time may stand beside ours.
struct AgreementDemand {
    /// Largest difference of joint accelerations, as a part of the largest acceleration; < 0: the engine does
    /// not tell accelerations.
    double acceleration{-1.0};
    /// Distance between the tips after the run, as a part of the length of the tip's path.
    double motion{0.0};
    /// Steps of the run and their length, s.
    int steps{0};
    double time_step{0.0};
};

/// One way to simulate the chain.
struct Peer {
    /// As in the names of the benchmarks: `peer_<name>/links:n`.
    std::string name;
    std::string version;
    /// Why the engine is not in this build; empty when it is.
    std::string missing;
    /// The chain as it is timed.
    std::unique_ptr<ChainPeer> (*make)(const ChainPlan& plan){nullptr};
    /// The chain as it is compared: the same, but an iterative engine gets enough iterations to converge.
    std::unique_ptr<ChainPeer> (*make_converged)(const ChainPlan& plan){nullptr};
    AgreementDemand demand;
    /// The chain in a method of fourth order; null when the engine has none.
    std::unique_ptr<ChainPeer> (*make_rk4)(const ChainPlan& plan){nullptr};
};

/// All peers, present or not.
[[nodiscard]] std::vector<Peer> all_peers();

/// The plan of a grounded serial chain of revolute joints without gravity, damping or limits. Throws
/// std::invalid_argument for any other linkage.
[[nodiscard]] ChainPlan plan_of(const LinkageSpec& spec);

/// Ours behind the same interface.
[[nodiscard]] std::unique_ptr<ChainPeer> make_own_chain(const LinkageSpec& spec);

} // namespace haptics::peers
