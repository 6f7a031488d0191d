// Experiment 2 of the paper: what couplings and feed-forwards make of a linkage of three links, against the
// same linkage without a device.

#include <haptics/shared/experiment2.hpp>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

namespace {

struct Way {
    const char* name;
    Coupling coupling;
    HandForce hand_force;
};

constexpr Way k_ways[] = {{"four_channel_transparent", Coupling::four_channel, HandForce::transparent},
                          {"four_channel_combined", Coupling::four_channel, HandForce::combined},
                          {"four_channel_paper", Coupling::four_channel, HandForce::paper},
                          {"virtual_coupling", Coupling::virtual_coupling, HandForce::combined}};

} // namespace

void write_experiment2(const Options& options) {
    CsvFile csv(options.folder / "experiment2.csv",
                {"method", "rate_hz", "hand_force_is", "handle_to_proxy_peak_m", "handle_to_proxy_rms_m",
                 "motion_error_rms_m", "fastest_handle_m_per_s", "energy_created_j",
                 "coupling_stiffness_n_per_m", "fault"});
    const std::vector<double> rates =
        options.quick ? std::vector<double>{1000.0} : std::vector<double>{500.0, 1000.0, 4000.0};
    double done = 0.0;
    for (const double rate : rates)
        for (const bool observed : {false, true})
            for (const Way& way : k_ways) {
                shared::Experiment2Options o;
                o.rate_hz = rate;
                o.coupling = way.coupling;
                o.hand_force = way.hand_force;
                o.observer = observed;
                const shared::Experiment2Outcome r = shared::run_experiment2(o);
                csv.row({way.name, rate, observed ? "observed, one step late" : "measured", r.peak, r.mean,
                         r.motion, r.fastest, r.energy, r.stiffness, r.faults != Fault::none});
                show_progress("experiment 2", ++done / (8.0 * static_cast<double>(rates.size())));
            }
    csv.finish();
}

} // namespace haptics::report
