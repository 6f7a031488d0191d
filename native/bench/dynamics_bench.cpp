/// Forward dynamics plus one semi-implicit update, Coriolis included: `dynamics/links:n`,
/// `dynamics/rigid_tool`, and the parts.

#include <haptics/core/dynamics/closed_chain.hpp>
#include <haptics/core/dynamics/dense_dynamics.hpp>
#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/mass_inverse.hpp>
#include <haptics/shared/linkages.hpp>

#include <benchmark/benchmark.h>

#include <memory>

namespace {

using namespace haptics;

/// A linkage in motion with its memory.
struct Bench {
    LinkageModel model;
    LinkageData data;
    ArticulatedFactor factor;
    DenseDynamics dense;
    LinkageVector force;
    LinkageVector acceleration;

    explicit Bench(const LinkageSpec& spec) {
        if (!build_model(spec, model).empty()) {
            std::abort();
        }
        reset(model, data);
        force.setZero(model.freedoms);
        for (int i = 0; i < model.freedoms; ++i) {
            data.position[i] = 0.1 * (i % 7) - 0.2;
            data.velocity[i] = 0.3 * (i % 5) - 0.5;
        }
    }

    void update() {
        constexpr double dt = 1e-5;
        for (int i = 0; i < model.freedoms; ++i) {
            data.velocity[i] += dt * acceleration[i];
            data.position[i] += dt * data.velocity[i];
        }
    }
};

void run_step(benchmark::State& state, const LinkageSpec& spec) {
    const auto bench = std::make_unique<Bench>(spec);
    for (auto _ : state) {
        step_semi_implicit(bench->model, bench->data, bench->force, 1e-5, bench->factor, bench->acceleration);
    }
    benchmark::DoNotOptimize(bench->data.position.data());
}

void chain_step(benchmark::State& state) {
    run_step(state, shared::chain(static_cast<int>(state.range(0))));
}
void floating_chain_step(benchmark::State& state) {
    run_step(state, shared::chain(static_cast<int>(state.range(0)), BaseKind::floating));
}
void rigid_tool_step(benchmark::State& state) {
    run_step(state, shared::rigid_tool());
}

void articulated_step(benchmark::State& state) {
    const auto bench = std::make_unique<Bench>(shared::chain(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        update_rotations(bench->model, bench->data);
        update_positions(bench->model, bench->data);
        articulated_acceleration(bench->model, bench->data, bench->force, nullptr, bench->factor,
                                 bench->acceleration);
        bench->update();
    }
}

void dense_step(benchmark::State& state) {
    const auto bench = std::make_unique<Bench>(shared::chain(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        update_rotations(bench->model, bench->data);
        update_positions(bench->model, bench->data);
        dense_acceleration(bench->model, bench->data, bench->force, nullptr, bench->dense,
                           bench->acceleration);
        bench->update();
    }
}

void rotations(benchmark::State& state) {
    const auto bench = std::make_unique<Bench>(shared::chain(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        update_rotations(bench->model, bench->data);
        benchmark::ClobberMemory();
    }
}

void kinematics(benchmark::State& state) {
    const auto bench = std::make_unique<Bench>(shared::chain(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        update_kinematics(bench->model, bench->data);
        benchmark::ClobberMemory();
    }
}

void solve_row(benchmark::State& state) {
    const auto bench = std::make_unique<Bench>(shared::chain(static_cast<int>(state.range(0))));
    update_kinematics(bench->model, bench->data);
    factorize(bench->model, bench->data, nullptr, bench->factor);
    bench->force.setOnes();
    for (auto _ : state) {
        solve(bench->model, bench->data, bench->factor, bench->force, bench->acceleration);
        benchmark::ClobberMemory();
    }
}

} // namespace

BENCHMARK(rigid_tool_step)->Name("dynamics/rigid_tool");
BENCHMARK(chain_step)
    ->Name("dynamics")
    ->ArgName("links")
    ->Arg(1)
    ->Arg(2)
    ->Arg(3)
    ->Arg(4)
    ->Arg(6)
    ->Arg(12)
    ->Arg(24)
    ->Arg(48)
    ->Arg(64);
BENCHMARK(floating_chain_step)->Name("dynamics_floating")->ArgName("links")->Arg(3)->Arg(48);
BENCHMARK(articulated_step)->Name("dynamics_articulated")->ArgName("links")->Arg(3)->Arg(12)->Arg(48);
BENCHMARK(dense_step)->Name("dynamics_dense")->ArgName("links")->Arg(3)->Arg(12)->Arg(48);
BENCHMARK(rotations)->Name("rotations")->ArgName("links")->Arg(3)->Arg(48);
BENCHMARK(kinematics)->Name("kinematics")->ArgName("links")->Arg(3)->Arg(48);
BENCHMARK(solve_row)->Name("solve_row")->ArgName("links")->Arg(3)->Arg(48);
