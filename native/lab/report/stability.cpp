#include <haptics/shared/observed_tool.hpp>
#include <haptics/sweep/stability.hpp>

#include <cmath>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

namespace {

const char* coupling_name(Coupling coupling) {
    switch (coupling) {
    case Coupling::four_channel:
        return "four_channel";
    case Coupling::virtual_coupling:
        return "virtual_coupling";
    case Coupling::direct:
        return "direct";
    }
    return "";
}

// stiffness from 1e2 to 1e9 N/m, `parts` of a decade each
std::vector<double> stiffnesses(int parts) {
    std::vector<double> all;
    for (int i = 0; i <= 7 * parts; ++i)
        all.push_back(std::pow(10.0, 2.0 + static_cast<double>(i) / parts));
    return all;
}

void write_proxy(const Options& options) {
    CsvFile csv(options.folder / "stability.csv",
                {"integrator", "rate_hz", "mass_kg", "stiffness_n_per_m", "damping_n_s_per_m", "growth",
                 "residual", "bounce", "verdict", "semi_implicit_floor_kg"});
    const std::vector<double> rates =
        options.quick ? std::vector<double>{500.0, 1000.0, 4000.0}
                      : std::vector<double>{250.0, 500.0, 1000.0, 2000.0, 4000.0, 10000.0};
    const std::vector<double> masses = {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
    constexpr double k_damping = 20.0;
    double done = 0.0;
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
        for (const double rate : rates) {
            for (const double mass : masses)
                for (const double stiffness : stiffnesses(options.quick ? 2 : 4)) {
                    const sweep::StabilityFigures f =
                        sweep::judge({integrator, stiffness, k_damping, rate, mass});
                    csv.row({name_of(integrator), rate, mass, stiffness, k_damping, f.growth, f.residual,
                             f.bounce, sweep::name_of(f.verdict),
                             sweep::semi_implicit_floor(stiffness, k_damping, 1.0 / rate)});
                }
            show_progress("stability, proxy alone", ++done / (3.0 * static_cast<double>(rates.size())));
        }
    csv.finish();
}

struct LoopFigures {
    double swing{0.0};
    double force_swing{0.0};
    double energy{0.0};
    bool fault{false};
    double coupling{0.0};

    // a handle that shakes by more than this under a steady push is not at rest, and by more than that is
    // lost
    [[nodiscard]] sweep::Verdict verdict() const {
        constexpr double k_quiet = 5e-5;
        constexpr double k_lost = 5e-3;
        if (fault || !(swing < k_lost))
            return sweep::Verdict::unstable;
        return swing < k_quiet ? sweep::Verdict::stable : sweep::Verdict::chattering;
    }
};

// 2 N on the handle from 0.5 s on; the last half second of 2.5 s is judged
LoopFigures judge_loop(const shared::ObservedToolOptions& o) {
    shared::ObservedTool tool(o);
    const long steps = std::lround(2.5 * o.rate_hz);
    double low[2] = {1e300, 1e300};
    double high[2] = {-1e300, -1e300};
    for (long i = 0; i < steps; ++i) {
        tool.session->step();
        if (static_cast<double>(i) < 2.0 * o.rate_hz)
            continue;
        const double now[2] = {tool.device->true_pose().y(), tool.session->report().contact.y()};
        for (std::size_t k = 0; k < 2; ++k) {
            low[k] = std::min(low[k], now[k]);
            high[k] = std::max(high[k], now[k]);
        }
    }
    const HapticReport& r = tool.session->report();
    return {high[0] - low[0], high[1] - low[1], r.energy_injected, r.faults != Fault::none,
            tool.session->gains().stiffness.y()};
}

void write_device(const Options& options) {
    CsvFile csv(options.folder / "stability_device.csv",
                {"coupling", "rate_hz", "delay_steps", "encoder_m", "device_mass_ratio", "stiffness_n_per_m",
                 "coulomb_friction_n", "coupling_stiffness_n_per_m", "handle_swing_m", "force_swing_n",
                 "energy_injected_j", "fault", "verdict"});
    const std::vector<double> rates =
        options.quick ? std::vector<double>{500.0} : std::vector<double>{500.0, 1000.0};
    const std::vector<int> delays = options.quick ? std::vector<int>{1} : std::vector<int>{1, 2, 4};
    const std::vector<double> encoders =
        options.quick ? std::vector<double>{1e-6} : std::vector<double>{1e-6, 1e-5, 5e-5};
    const std::vector<double> ratios =
        options.quick ? std::vector<double>{1.0} : std::vector<double>{0.75, 1.0, 1.25};
    const std::vector<double> walls = stiffnesses(options.quick ? 1 : 2);
    // dry friction matters where the wall itself is rendered at the encoder's steps
    const auto frictions = [](Coupling coupling) {
        return coupling == Coupling::direct ? std::vector<double>{0.0, 0.2} : std::vector<double>{0.0};
    };
    const double total = 4.0 * static_cast<double>(rates.size() * delays.size() * encoders.size() *
                                                   ratios.size() * walls.size());
    double done = 0.0;
    for (const Coupling coupling : {Coupling::direct, Coupling::virtual_coupling, Coupling::four_channel})
        for (const double rate : rates)
            for (const int delay : delays)
                for (const double encoder : encoders)
                    for (const double ratio : ratios)
                        for (const double friction : frictions(coupling))
                            for (const double wall : walls) {
                                shared::ObservedToolOptions o;
                                o.coupling = coupling;
                                o.rate_hz = rate;
                                o.delay_steps = delay;
                                o.encoder = encoder;
                                o.coulomb = friction;
                                o.mass_ratio = ratio;
                                o.wall = wall;
                                o.observer = coupling != Coupling::direct;
                                const LoopFigures f = judge_loop(o);
                                csv.row({coupling_name(coupling), rate, delay, encoder, ratio, wall, friction,
                                         f.coupling, f.swing, f.force_swing, f.energy, f.fault,
                                         sweep::name_of(f.verdict())});
                                show_progress("stability, device in the loop", ++done / total);
                            }
    csv.finish();
}

} // namespace

void write_stability(const Options& options) {
    write_proxy(options);
    write_device(options);
}

} // namespace haptics::report
