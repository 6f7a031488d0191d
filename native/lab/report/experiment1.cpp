// Experiment 1 of the paper with the paper's wall and a coupling that follows the rate, its device as in the
// tests: what the two contact models do to it for each integrator, rate and tool mass; and the two motions at
// 500 Hz as they go.

#include <haptics/shared/feel.hpp>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

namespace {

constexpr ContactMode k_modes[] = {ContactMode::penalty, ContactMode::penalty_impulse};

const char* mode_name(ContactMode mode) {
    return mode == ContactMode::penalty ? "penalty" : "penalty_impulse";
}

void write_traces(const Options& options) {
    CsvFile csv(options.folder / "experiment1_trace.csv",
                {"method", "t_s", "handle_y_m", "tool_y_m", "contact_force_n", "felt_force_n"});
    for (const ContactMode mode : k_modes) {
        shared::Experiment1Options o;
        o.contact = mode;
        shared::Experiment1 e(o);
        for (int i = 0; i < 1500; ++i) {
            e.session->step();
            const HapticReport& r = e.session->report();
            csv.row({mode_name(mode), r.time, e.device->true_pose().y(), r.proxy.y() - 0.01, r.contact.y(),
                     r.force.y()});
        }
    }
    csv.finish();
}

} // namespace

void write_experiment1(const Options& options) {
    CsvFile csv(options.folder / "experiment1.csv",
                {"method", "integrator", "rate_hz", "tool_mass_kg", "coupling_stiffness_n_per_m", "settles_s",
                 "force_swing_n", "handle_swing_m", "energy_created_j", "largest_force_n"});
    double done = 0.0;
    for (const ContactMode mode : k_modes)
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const double rate : {500.0, 1000.0, 2000.0}) {
                for (const double mass : {0.1, 0.3, 1.0}) {
                    shared::Experiment1Options o;
                    o.contact = mode;
                    o.integrator = integrator;
                    o.rate_hz = rate;
                    o.tool_mass = mass;
                    const shared::Experiment1Outcome r = shared::outcome_of(o);
                    csv.row({mode_name(mode), name_of(integrator), rate, mass, r.stiffness,
                             r.settling < 0.0 ? Field("never") : Field(r.settling), r.force_swing,
                             r.handle_swing, r.energy, r.largest_force});
                }
                show_progress("experiment 1", ++done / 18.0);
            }
    csv.finish();
    write_traces(options);
}

void write_feel(const Options& options) {
    CsvFile csv(options.folder / "feel.csv", {"scene", "t_s", "handle_x_m", "handle_y_m", "handle_theta_rad",
                                              "force_x_n", "force_y_n", "torque_nm"});
    for (const shared::FeelTrace& trace : shared::feel_traces())
        for (const shared::FeelSample& s : trace.sample)
            csv.row({trace.name, s.time, s.handle.x(), s.handle.y(), s.handle.z(), s.force.x(), s.force.y(),
                     s.force.z()});
    csv.finish();
}

} // namespace haptics::report
