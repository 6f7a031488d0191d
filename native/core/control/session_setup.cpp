// How a session begins: checks of its settings, gains and observer.

#include <haptics/core/control/coupling_design.hpp>
#include <haptics/core/control/session.hpp>

namespace haptics {

std::vector<FigureError> validate(const SessionSettings& s) {
    FigureCheck check;
    check.range("rate", s.step > 0.0 ? 1.0 / s.step : 0.0, 250.0, 100000.0, "Hz",
                "1000 Hz is the default; above 10000 Hz only in lock-step.");
    check.append(validate(HandPlacement{s.mapping, false, 0.0}));
    for (int i = 0; i < 3; ++i) {
        const bool turns = i == 2;
        check.range(turns ? "coupling_rotation_stiffness" : "coupling_stiffness", s.gains.stiffness(i), 0.0,
                    1e9, turns ? "N m/rad" : "N/m", "0 chooses it from device mass and rate.");
        check.range(turns ? "coupling_rotation_damping" : "coupling_damping", s.gains.damping(i), 0.0, 1e9,
                    turns ? "N m s/rad" : "N s/m", "0 chooses it from device mass and rate.");
        check.range("reading_error", s.reading_error(i), 0.0, 0.1, "m", "Half an encoder step.");
    }
    check.range("device_patience", s.device_patience, 0.002, 1.0, "s", "0.02 is the default.");
    check.range("velocity_window", static_cast<double>(s.velocity_window), 0.0, 63.0, "samples",
                "0 chooses it from the encoder.");
    check.range("observer.delay", s.observer.delay, 0.0, HandleObserver::k_most_delay * s.step, "s",
                "The time from a reading to the force that answers it.");
    check.range("observer.bandwidth", s.observer.bandwidth, 0.0, 1e5, "rad/s", "0 chooses it.");
    check.range("observer.rotation_bandwidth", s.observer.rotation_bandwidth, 0.0, 1e5, "rad/s",
                "0 chooses it.");
    check.range("observer_noise", s.observer.noise, 0.001, 10.0, "N", "0.05 is the default.");
    check.range("observer_mass_error", s.observer.mass_error, 0.0, 0.5, "", "0.25 is the default.");
    check.range("hidden_inertia", s.hidden_inertia, 0.0, 0.95, "", "0 leaves all of it to the hand.");
    check.range("sample_period", s.sample_period, 0.0, 0.02, "s", "0 for a device as fast as the loop.");
    check.range("device_delay", s.device_delay, 0.0, 1.0, "s", "Most devices add less than 0.001 s.");
    return check.take();
}

std::vector<FigureError> validate(const SessionSettings& s, const Model& model) {
    FigureCheck check;
    check.append(validate(s));
    if (model.tool.articulated && s.coupling == Coupling::direct)
        check.inconsistent(
            "coupling", 2.0, 0.0, 1.0, "(0 four_channel, 1 virtual_coupling, 2 direct)",
            "Direct rendering needs a rigid tool: a linkage's joints do not follow from the handle.");
    return check.take();
}

Session::Session(const SessionSettings& settings, const Model& model, const OutputGate& gate,
                 DevicePort& device, const LinkageVector& start)
    : settings_(settings)
    , model_(std::make_unique<Model>(model))
    , data_(std::make_unique<Data>())
    , gate_(gate)
    , device_(device)
    , care_(settings.care, gate, settings.reading_error)
    , velocity_(settings.reading_error)
    , passivity_(settings.reading_error)
    , placement_(HandPlacement{settings.mapping, false, 0.0}) {
    reset(*model_, *data_, start);
    arm_wanted_ = settings.arm_at_start;
    mobility_ = grip_mobility(*model_, *data_);
    read_device();
    device_mass_ = settings_.mapping.mass_to_scene(device_.handle_mass(reading_.pose));
    choose_gains();
    hold(settings_.hold_at_start);
    report_.grip = grip_pose(data_->grip, data_->pose);
    report_.proxy = data_->pose;
    report_.device = target();
    report_.held = held_;
    report_linkage();
}

// in the device's axes; the scene sees forces divided by the scale and motions multiplied by it
void Session::choose_gains() {
    gains_ = settings_.gains;
    const bool chosen = !gains_.stiffness.isZero(0.0) || !gains_.damping.isZero(0.0);
    gains_follow_scale_ = !chosen;
    hidden_ = {Vec3::Constant(settings_.hidden_inertia), settings_.hidden_inertia};
    VelocityWindow window;
    const bool observed = settings_.observer.enabled && observe(chosen);
    if (!observed && !chosen) {
        const double period = std::max(settings_.step, settings_.sample_period);
        if (settings_.velocity_window > 0)
            window = {settings_.velocity_window, settings_.velocity_window};
        else if (settings_.coupling != Coupling::direct)
            window = choose_velocity_window(device_mass_, loop_mobility(), period, settings_.device_delay,
                                            2.0 * settings_.reading_error, settings_.observer.noise,
                                            settings_.observer.noise * ObserverSettings::k_arm);
        gains_ = default_gains(device_mass_, loop_mobility(), period, settings_.device_delay, window.lag);
    }
    velocity_ = VelocityEstimator(settings_.reading_error,
                                  settings_.velocity_window > 0 ? settings_.velocity_window : window.longest);
}

// false when no coupling holds with what the device is said to be
bool Session::observe(bool gains_chosen) {
    const ObserverSettings& wanted = settings_.observer;
    const Mat3 mass = device_.handle_mass(reading_.pose);
    LoopFigures figures;
    figures.step = settings_.step;
    figures.delay = wanted.delay;
    figures.mass_error = wanted.mass_error;
    figures.four_channel = settings_.coupling == Coupling::four_channel;
    figures.transparent = settings_.hand_force == HandForce::transparent;
    figures.hidden = settings_.hidden_inertia;
    figures.mass = lightest_mass(mass);
    figures.quantum = 2.0 * settings_.reading_error.head<2>().maxCoeff();
    figures.noise = wanted.noise;
    const CouplingDesign translation = design_coupling(figures);
    figures.mass = mass(2, 2);
    figures.quantum = 2.0 * settings_.reading_error.z();
    figures.noise = wanted.noise * ObserverSettings::k_arm;
    figures.hand_stiffness = 2.0;
    figures.hand_damping = 0.02;
    const CouplingDesign rotation = design_coupling(figures);
    if (translation.stiffness == 0.0 || rotation.stiffness == 0.0)
        return false;
    hidden_.alone = Vec3(translation.hidden, translation.hidden, rotation.hidden);
    if (!gains_chosen) {
        const double scale = settings_.mapping.scale * settings_.mapping.scale;
        gains_.stiffness =
            Vec3(translation.stiffness / scale, translation.stiffness / scale, rotation.stiffness);
        gains_.damping = Vec3(translation.damping / scale, translation.damping / scale, rotation.damping);
    }
    const double along = wanted.bandwidth > 0.0 ? wanted.bandwidth : translation.bandwidth;
    const double around = wanted.rotation_bandwidth > 0.0 ? wanted.rotation_bandwidth : rotation.bandwidth;
    observer_.emplace(settings_.step, wanted.delay, Vec3(along, along, around));
    observer_->sent(Wrench::Zero(), mass);
    return true;
}

// Both force channels or none: the environment's alone would let the hand feel the contact once fed forward
// and once through the spring.
bool Session::feeds_forward() const {
    return settings_.coupling == Coupling::four_channel && (reading_.has_hand_force || observer_);
}

// a linkage can be light in some pose and stretched in another: its gains are those of the lightest proxy
Mat3 Session::loop_mobility() const {
    if (!feeds_forward())
        return Mat3::Zero();
    return model_->tool.articulated ? Mat3(1e12 * Mat3::Identity()) : mobility_;
}

} // namespace haptics
