// The set-up of experiment 1 with coupling gains that do not change with the rate, so that all rates approach
// one continuous motion; an encoder would add noise of its own and is left out. The reference is the same
// loop at rates no device reaches, with exact contacts: what remains there is the loop's one step of delay,
// which halves with each refinement.

#include "device_experiment.hpp"

#include <haptics/shared/experiment1.hpp>

#include <cmath>

namespace haptics::report {

using sweep::Method;
using sweep::Scheme;
using sweep::Setting;

namespace {

constexpr double k_seconds = 1.2;

class DeviceRun final : public sweep::Run {
  public:
    explicit DeviceRun(const Setting& setting)
        : step_(1.0 / setting.rate) {
        shared::Experiment1Options o;
        o.contact = setting.method == Method::penalty ? ContactMode::penalty : ContactMode::penalty_impulse;
        o.integrator = setting.scheme == Scheme::semi_implicit ? Integrator::semi_implicit
                       : setting.scheme == Scheme::exact       ? Integrator::exact
                                                               : Integrator::linearly_implicit;
        o.rate_hz = setting.rate;
        o.tool_mass = 0.3;
        o.encoder = 0.0;
        o.distance = 0.005;
        o.fixed_gains.stiffness = Vec3(526.0, 526.0, 0.5);
        o.fixed_gains.damping = Vec3(17.6, 17.6, 0.01);
        experiment_ = std::make_unique<shared::Experiment1>(o);
    }
    void step() override {
        experiment_->session->step();
        const StepOutput& out = experiment_->session->output();
        impulse_ += step_ * out.contact.head<2>() + out.collision_impulse.head<2>();
    }
    sweep::Sample sample() override {
        const HapticReport& r = experiment_->session->report();
        constexpr double k_mass = 0.3;
        const double gap = std::min(0.0, r.proxy.y() - 0.01);
        return {r.proxy.head<2>(),
                0.5 * k_mass * r.velocity.head<2>().squaredNorm() + 0.5 * 15000.0 * gap * gap, impulse_};
    }

  private:
    std::unique_ptr<shared::Experiment1> experiment_;
    double step_;
    Vec2 impulse_{0.0, 0.0};
};

} // namespace

sweep::Experiment device_experiment() {
    sweep::Experiment e;
    e.name = "experiment1";
    e.title =
        "Experiment 1 of the paper: 2 N on the handle of a device of 0.3 kg drive a tool of 0.3 kg into the "
        "wall, "
        "coupling 526 N/m, four channels. Against the loop without delay; run times include the simulated "
        "device and hand.";
    e.seconds = k_seconds;
    e.schemes = {Scheme::semi_implicit, Scheme::linearly_implicit, Scheme::exact};
    e.methods = {Method::penalty, Method::impulse};
    e.start = [](const Setting& setting) { return std::make_unique<DeviceRun>(setting); };
    e.reference = [e](Method method, int refinement) {
        return sweep::follow(e, {Scheme::exact, method, 64000.0 * (1 << refinement)});
    };
    return e;
}

} // namespace haptics::report
