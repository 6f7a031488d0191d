/// Steps of a rigid tool with friction in n contacts: `tool/contacts:n` with the default integrator and
/// `tool/<integrator>/contacts:n` without the search for contacts, `tool_held/…` the same with the coupling
/// to a hand, `tool_detection/contacts:n` the search alone, `tool_step/contacts:n` the whole step.

#include <haptics/core/contact/detection.hpp>
#include <haptics/shared/tool_in_socket.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace haptics;

void run(benchmark::State& state, Integrator integrator, bool held) {
    shared::ToolInSocket socket = shared::tool_in_socket(static_cast<int>(state.range(0)), integrator, held);
    for (auto _ : state)
        step_without_detection(socket.model, *socket.data, socket.hand, socket.time_step, socket.output);
    benchmark::DoNotOptimize(socket.output.contacts);
    if (socket.output.contacts != state.range(0))
        state.SkipWithError("the contacts were lost");
    state.counters["sticking"] = socket.output.sticking;
}

void by_default(benchmark::State& state) {
    run(state, LocalModelSettings{}.integrator, false);
}
void semi_implicit(benchmark::State& state) {
    run(state, Integrator::semi_implicit, false);
}
void linearly_implicit(benchmark::State& state) {
    run(state, Integrator::linearly_implicit, false);
}
void held(benchmark::State& state) {
    run(state, LocalModelSettings{}.integrator, true);
}

void whole_step(benchmark::State& state) {
    shared::ToolInSocket socket =
        shared::tool_in_socket(static_cast<int>(state.range(0)), LocalModelSettings{}.integrator);
    for (auto _ : state)
        shared::step(socket);
    benchmark::DoNotOptimize(socket.output.contacts);
}

void detection(benchmark::State& state) {
    shared::ToolInSocket socket =
        shared::tool_in_socket(static_cast<int>(state.range(0)), Integrator::linearly_implicit);
    Data& data = *socket.data;
    const DetectionSettings settings{socket.model.settings.margin, socket.time_step};
    PatchList found = data.patches;
    for (auto _ : state) {
        detect_patches(data.tool, data.tool_cache, data.neighbors, data.neighbor_cache, settings, found,
                       found);
        benchmark::DoNotOptimize(found.count);
    }
}

#define HAPTICS_CONTACTS ->ArgName("contacts")->Arg(0)->Arg(4)->Arg(16)->Arg(64)
BENCHMARK(by_default)->Name("tool") HAPTICS_CONTACTS;
BENCHMARK(semi_implicit)->Name("tool/semi_implicit") HAPTICS_CONTACTS;
BENCHMARK(linearly_implicit)->Name("tool/linearly_implicit") HAPTICS_CONTACTS;
BENCHMARK(held)->Name("tool_held") HAPTICS_CONTACTS;
BENCHMARK(whole_step)->Name("tool_step") HAPTICS_CONTACTS;
BENCHMARK(detection)->Name("tool_detection") HAPTICS_CONTACTS;
#undef HAPTICS_CONTACTS

} // namespace
