/// One whole haptic step of a rigid tool with friction in n contacts: `tool/contacts:n` with the default
/// integrator, `tool/<integrator>/contacts:n`, `tool_held/…` with the coupling to a hand, and
/// `tool_detection/contacts:n`, the part of it that finds the contacts.

#include <haptics/core/contact/detection.hpp>
#include <haptics/shared/tool_in_socket.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace haptics;

void run(benchmark::State& state, Integrator integrator, bool held) {
    shared::ToolInSocket socket = shared::tool_in_socket(static_cast<int>(state.range(0)), integrator, held);
    for (auto _ : state)
        shared::step(socket);
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

void detection(benchmark::State& state) {
    const shared::ToolInSocket socket =
        shared::tool_in_socket(static_cast<int>(state.range(0)), Integrator::linearly_implicit);
    const Data& data = *socket.data;
    const DetectionSettings settings{socket.model.settings.margin, socket.time_step};
    PatchList found = data.patches;
    PatchList previous = data.patches;
    for (auto _ : state) {
        previous = found;
        detect_patches(data.tool, data.neighbors, settings, previous, found);
        benchmark::DoNotOptimize(found.count);
    }
}

#define HAPTICS_CONTACTS ->ArgName("contacts")->Arg(0)->Arg(4)->Arg(16)->Arg(64)
BENCHMARK(by_default)->Name("tool") HAPTICS_CONTACTS;
BENCHMARK(semi_implicit)->Name("tool/semi_implicit") HAPTICS_CONTACTS;
BENCHMARK(linearly_implicit)->Name("tool/linearly_implicit") HAPTICS_CONTACTS;
BENCHMARK(held)->Name("tool_held") HAPTICS_CONTACTS;
BENCHMARK(detection)->Name("tool_detection") HAPTICS_CONTACTS;
#undef HAPTICS_CONTACTS

} // namespace
