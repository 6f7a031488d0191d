/// One call of resolve_collisions per iteration, over a ring of random problems with this many contacts.

#include <haptics/shared/collision_scenes.hpp>

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

namespace {

using namespace haptics;
using namespace haptics::shared;

constexpr std::size_t k_ring = 16;

struct Ring {
    std::vector<CollisionScene> scenes;
    std::unique_ptr<CollisionWorkspace> workspace{std::make_unique<CollisionWorkspace>()};
    CollisionSolution solution;

    Ring(const CollisionMix& mix, int contacts)
        : scenes(k_ring) {
        Dice dice(31);
        CollisionMix fixed = mix;
        fixed.least_contacts = contacts;
        fixed.most_contacts = contacts;
        for (CollisionScene& scene : scenes) {
            // all take part: at least one closes
            do
                random_scene(dice, fixed, scene);
            while ((scene.problem.normal_rows * scene.problem.velocity).minCoeff() >= -1e-3);
        }
    }
    void run(benchmark::State& state, CollisionMethod method) {
        std::size_t next = 0;
        int iterations = 0;
        int fell_back = 0;
        for (auto _ : state) {
            resolve_collisions(method, scenes[next].problem, *workspace, solution);
            benchmark::DoNotOptimize(solution.velocity.data());
            iterations += solution.iterations;
            fell_back += solution.fell_back ? 1 : 0;
            next = (next + 1) % k_ring;
        }
        state.counters["solver_iterations"] =
            benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
        state.counters["fell_back"] = benchmark::Counter(fell_back, benchmark::Counter::kAvgIterations);
    }
};

CollisionMix rigid_mix(bool friction) {
    CollisionMix mix;
    mix.most_links = 0;
    mix.friction = friction;
    mix.singular = false;
    return mix;
}

void rigid_tool(benchmark::State& state) {
    Ring(rigid_mix(false), static_cast<int>(state.range(0))).run(state, CollisionMethod::poisson);
}

void rigid_tool_with_friction(benchmark::State& state) {
    Ring(rigid_mix(true), static_cast<int>(state.range(0))).run(state, CollisionMethod::poisson);
}

void twelve_links_with_friction(benchmark::State& state) {
    CollisionMix mix;
    mix.no_rigid = true;
    mix.fewest_links = 12;
    mix.singular = false;
    Ring(mix, static_cast<int>(state.range(0))).run(state, CollisionMethod::poisson);
}

/// The one of 3000 problems that takes most iterations: 12 links, 17 to 32 contacts, singular ones too.
void hard(benchmark::State& state) {
    CollisionMix mix;
    mix.no_rigid = true;
    mix.fewest_links = 12;
    mix.least_contacts = 17;
    mix.most_contacts = 32;
    Dice dice(32);
    auto scene = std::make_unique<CollisionScene>();
    auto hardest = std::make_unique<CollisionScene>();
    auto workspace = std::make_unique<CollisionWorkspace>();
    CollisionSolution solution;
    int most = -1;
    for (int k = 0; k < 3000; ++k) {
        random_scene(dice, mix, *scene);
        resolve_collisions(CollisionMethod::poisson, scene->problem, *workspace, solution);
        if (solution.iterations > most) {
            most = solution.iterations;
            *hardest = *scene;
        }
    }
    for (auto _ : state) {
        resolve_collisions(CollisionMethod::poisson, hardest->problem, *workspace, solution);
        benchmark::DoNotOptimize(solution.velocity.data());
    }
    state.counters["solver_iterations"] = solution.iterations;
    state.counters["fell_back"] = solution.fell_back ? 1 : 0;
}

void mass_weighted(benchmark::State& state) {
    Ring(rigid_mix(false), static_cast<int>(state.range(0))).run(state, CollisionMethod::mass_weighted);
}

void paper(benchmark::State& state) {
    Ring(rigid_mix(false), static_cast<int>(state.range(0))).run(state, CollisionMethod::paper);
}

BENCHMARK(rigid_tool)
    ->Name("collision/rigid")
    ->ArgName("contacts")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->Arg(64);
BENCHMARK(rigid_tool_with_friction)
    ->Name("collision/rigid_friction")
    ->ArgName("contacts")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->Arg(64);
BENCHMARK(twelve_links_with_friction)
    ->Name("collision/links12_friction")
    ->ArgName("contacts")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->Arg(64);
BENCHMARK(hard)->Name("collision/hard");
BENCHMARK(mass_weighted)->Name("collision/mass_weighted")->ArgName("contacts")->Arg(1)->Arg(4)->Arg(16);
BENCHMARK(paper)->Name("collision/paper")->ArgName("contacts")->Arg(1)->Arg(4)->Arg(16);

} // namespace
