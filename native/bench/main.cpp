/// Runs the benchmarks on one core, with the other engines beside ours in the same run. An engine that does
/// not compute our motion fails the run before anything is timed; one that is not here is named with the
/// reason.

#include <haptics/peers/agreement.hpp>
#include <haptics/shared/linkages.hpp>

#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include "host.hpp"
#include "peers_bench.hpp"
#include "peers_report.hpp"

namespace {

using namespace haptics;

/// Google Benchmark's JSON, closed with what the host took meanwhile.
class JsonWithHost final : public benchmark::JSONReporter {
  public:
    void Finalize() override {
        GetOutputStream() << "\n  ],\n  \"host_share\": " << share_.json() << "\n}\n";
    }

  private:
    bench::HostShare share_;
};

std::string scientific(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.1e", value);
    return text;
}

/// A chain of unlike bodies: what rods of one kind in a line would not show.
LinkageSpec unlike_chain() {
    shared::Random random(7);
    shared::RandomLinkage kind;
    kind.links = 6;
    kind.serial = true;
    kind.prismatic = 0.0;
    kind.fixed = 0.0;
    LinkageSpec spec = shared::random_linkage(random, kind);
    spec.gravity.setZero();
    return spec;
}

/// True when `peer` computes our motion on every chain; says what was seen.
bool agrees(const peers::Peer& peer) {
    struct Case {
        const char* name;
        LinkageSpec spec;
    };
    bool all = true;
    std::string told;
    for (const Case& chain :
         {Case{"3 links", shared::chain(3)}, {"6 unlike", unlike_chain()}, {"48 links", shared::chain(48)}}) {
        const auto simulated = peer.make_converged(peers::plan_of(chain.spec));
        const peers::Agreement seen = peers::compare(*simulated, chain.spec, peer.demand, 20, 1);
        const auto as_timed = peer.make(peers::plan_of(chain.spec));
        const peers::Agreement timed = peers::compare(*as_timed, chain.spec, peer.demand, 20, 1);
        told += told.empty() ? "" : "; ";
        told += std::string(chain.name) + ": ";
        if (seen.acceleration >= 0.0)
            told += "accelerations " + scientific(seen.acceleration) + ", ";
        told += "tip " + scientific(seen.motion);
        if (peer.make != peer.make_converged)
            told += " (as timed " + scientific(timed.motion) + ")";
        if (!seen.holds) {
            all = false;
            std::fprintf(stderr,
                         "peer_%s does not compute our motion: %s; at most %.1e and %.1e are allowed\n",
                         peer.name.c_str(), told.c_str(), peer.demand.acceleration, peer.demand.motion);
        }
    }
    std::fprintf(stderr, "peer_%-13s %-6s agrees: relative difference with %s\n", peer.name.c_str(),
                 peer.version.c_str(), told.c_str());
    benchmark::AddCustomContext("peer_" + peer.name, peer.version);
    benchmark::AddCustomContext("peer_" + peer.name + "_difference", told);
    return all;
}

/// False when a peer that is here computes something else.
bool take_peers() {
    bool all = true;
    for (const peers::Peer& peer : peers::all_peers()) {
        if (!peer.missing.empty()) {
            std::fprintf(stderr, "peer_%s is MISSING: %s\n", peer.name.c_str(), peer.missing.c_str());
            benchmark::AddCustomContext("peer_" + peer.name, "missing: " + peer.missing);
            continue;
        }
        all = agrees(peer) && all;
        bench::register_peer(peer);
    }
    return all;
}

int run(int argc, char** argv) {
    // haptics_bench --report=FOLDER [--quick]: no benchmarks, but the report's tables of other engines
    constexpr std::string_view k_report = "--report=";
    const bool quick = argc == 3 && std::string_view(argv[2]) == "--quick";
    if ((argc == 2 || quick) && std::string_view(argv[1]).starts_with(k_report)) {
        bench::pin_to_one_core();
        bench::write_peer_tables(std::string(argv[1] + k_report.size()), quick);
        return 0;
    }
    bool writes_file = false;
    for (int i = 1; i < argc; ++i)
        writes_file = writes_file || std::string(argv[i]).starts_with("--benchmark_out=");
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 2;
    const std::string core = bench::pin_to_one_core();
    benchmark::AddCustomContext("core", core);
    std::fprintf(stderr, "core %s\n", core.c_str());
    if (!take_peers())
        return 1;
    JsonWithHost file;
    const std::size_t count =
        writes_file ? benchmark::RunSpecifiedBenchmarks(nullptr, &file) : benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return count > 0 ? 0 : 2;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "the benchmarks cannot run: %s\n", problem.what());
        return 1;
    }
}
