#include <haptics/sweep/work_precision.hpp>

#include "csv.hpp"
#include "device_experiment.hpp"
#include "tables.hpp"

namespace haptics::report {

void write_error_vs_runtime(const Options& options) {
    CsvFile csv(options.folder / "error_vs_runtime.csv",
                {"experiment", "motion", "method", "integrator", "rate_hz", "position_rms_m",
                 "position_max_m", "force_rms_n", "energy_max_j", "reference_difference_m", "error_is",
                 "ns_per_step", "ns_per_step_low", "ns_per_step_high", "us_per_simulated_s", "front",
                 "recommended"});
    CsvFile recommended(options.folder / "recommended.csv",
                        {"experiment", "motion", "method", "title", "reason"});
    sweep::SweepOptions how;
    how.repeats = options.repeats();
    if (options.quick)
        how.rates = {500.0, 1000.0, 2000.0, 10000.0};
    const sweep::Experiment experiments[] = {sweep::pulled_tool(),   sweep::swinging_chain(),
                                             sweep::bouncing_tool(), sweep::pressing_tool(),
                                             sweep::sliding_tool(),  device_experiment()};
    for (const sweep::Experiment& experiment : experiments) {
        how.progress = [&experiment](double share) { show_progress(experiment.name.c_str(), share); };
        const sweep::WorkPrecision result = sweep::sweep(experiment, how);
        const char* motion = experiment.smooth ? "smooth" : "contact";
        for (const sweep::WorkPrecisionRow& r : result.rows)
            csv.row({experiment.name, motion, name_of(r.setting.method), name_of(r.setting.scheme),
                     r.setting.rate, r.error.position_rms, r.error.position_max, r.error.force_rms,
                     r.error.energy_max, r.reference_difference, name_of(r.trust), r.step_ns.median,
                     r.step_ns.low, r.step_ns.high, r.second_us, r.front, r.recommended});
        for (const sweep::WorkPrecision::Reason& r : result.reasons)
            recommended.row({experiment.name, motion, name_of(r.method), experiment.title, r.text});
    }
    csv.finish();
    recommended.finish();
}

} // namespace haptics::report
