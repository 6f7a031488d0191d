#pragma once
/// The tables of the report, one file each.

#include <haptics/core/local_model/model.hpp>

#include <filesystem>

namespace haptics::report {

struct Options {
    std::filesystem::path folder;
    bool quick{false};
    /// Timed repeats of each figure.
    [[nodiscard]] int repeats() const { return quick ? 7 : 21; }
};

/// error_vs_runtime.csv and recommended.csv: every experiment by scheme, method and rate.
void write_error_vs_runtime(const Options& options);
/// stability.csv (the proxy alone) and stability_device.csv (with the device in the loop).
void write_stability(const Options& options);
/// plan.csv: what scenes leave out, and what that saves.
void write_plan(const Options& options);

[[nodiscard]] const char* name_of(Integrator integrator);

/// experiment1.csv: what becomes of experiment 1 of the paper; experiment1_trace.csv: two of its motions.
void write_experiment1(const Options& options);

/// experiment2.csv: what couplings make of experiment 2.
void write_experiment2(const Options& options);
/// extreme.csv: cases at and beyond the edge, each with its figure and bound.
void write_extreme(const Options& options);

/// feel.csv: the traces whose feel is kept, as they are now.
void write_feel(const Options& options);

/// What was measured on a scene of the user's (tools/run/scene_sweep.gd left it in the folder) becomes
/// scene_error.csv, scene_recommended.csv, scene_loop.csv, scene_stability.csv and scene_plan.csv.
void write_scene(const Options& options);

/// A line of progress on the terminal.
void show_progress(const char* what, double share);

} // namespace haptics::report
