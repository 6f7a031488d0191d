/// The same chain stepped by other engines: `peer_<engine>/links:n`. Registered by main() for the engines
/// that are there and compute our motion.

#include "peers_bench.hpp"

#include <haptics/shared/linkages.hpp>

#include <benchmark/benchmark.h>

#include <cmath>

namespace haptics::bench {
namespace {

// the state that dynamics_bench starts from
std::vector<double> start_position(int links) {
    std::vector<double> position;
    for (int i = 0; i < links; ++i)
        position.push_back(0.1 * (i % 7) - 0.2);
    return position;
}
std::vector<double> start_velocity(int links) {
    std::vector<double> velocity;
    for (int i = 0; i < links; ++i)
        velocity.push_back(0.3 * (i % 5) - 0.5);
    return velocity;
}

void run(benchmark::State& state, const peers::Peer& peer) {
    const int links = static_cast<int>(state.range(0));
    const auto chain = peer.make(peers::plan_of(shared::chain(links)));
    std::vector<double> position = start_position(links);
    std::vector<double> velocity = start_velocity(links);
    chain->set_state(position.data(), velocity.data());
    for (auto _ : state)
        chain->step(k_chain_time_step);
    chain->get_state(position.data(), velocity.data());
    for (const double value : velocity)
        if (!std::isfinite(value))
            state.SkipWithError("the motion blew up");
}

} // namespace

void register_peer(const peers::Peer& peer) {
    benchmark::RegisterBenchmark(("peer_" + peer.name).c_str(),
                                 [peer](benchmark::State& state) { run(state, peer); })
        ->ArgName("links")
        ->Arg(3)
        ->Arg(6)
        ->Arg(12)
        ->Arg(24)
        ->Arg(48);
}

} // namespace haptics::bench
