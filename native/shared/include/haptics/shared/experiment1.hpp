#pragma once
/// Experiment 1 of the paper: a constant hand force of 2 N drives a rectangular tool into a wall of 15000 N/m
/// and 20 N s/m at 500 Hz, with and without collision impulses.

#include <haptics/core/control/session.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace haptics::shared {

struct Experiment1Options {
    ContactMode contact{ContactMode::penalty_impulse};
    Integrator integrator{Integrator::semi_implicit};
    Coupling coupling{Coupling::four_channel};
    double rate_hz{500.0};
    double tool_mass{0.3};
    double device_mass{0.3};
    double device_friction{1.0};
    double push{2.0};
    int delay_steps{1};
    double encoder{10e-6};
    /// Multiplies the coupling of a position loop alone (1577 N/m at 500 Hz); damping grows with its root.
    double gain{1.0};
    int velocity_window{1};
    bool measures_force{true};
    /// Distance from tool to wall at the start, m.
    double distance{0.02};
    /// Coupling that does not follow the rate; all zero for the rate's own.
    CouplingGains fixed_gains;
};

struct Experiment1 {
    explicit Experiment1(const Experiment1Options& o) {
        SimulatedPantographOptions d;
        d.mass = o.device_mass;
        d.inertia = 3e-4;
        d.viscous_friction = o.device_friction;
        d.encoder_model = o.encoder > 0.0 ? EncoderModel::handle : EncoderModel::exact;
        d.encoder_resolution = Vec3(o.encoder, o.encoder, 1e-4);
        d.command_delay_steps = o.delay_steps;
        d.measures_force = o.measures_force;
        d.limit_motors = false;
        d.hand = pushing_hand(Wrench(0.0, -o.push, 0.0), 1.0);
        device = std::make_unique<SimulatedPantograph>(d);
        Model model = box_tool(o.tool_mass);
        model.settings.contact_mode = o.contact;
        model.settings.integrator = o.integrator;
        SessionSettings s;
        s.step = 1.0 / o.rate_hz;
        s.velocity_window = o.velocity_window;
        s.coupling = o.coupling;
        s.device_delay = (o.delay_steps - 1) * s.step;
        s.reading_error = Vec3(0.5 * o.encoder, 0.5 * o.encoder, 0.5e-4);
        Mat3 mass = Vec3(o.device_mass, o.device_mass, 3e-4).asDiagonal();
        s.gains = default_gains(mass, Mat3::Zero(), s.step, 0.0, 1);
        s.gains.stiffness *= o.gain;
        s.gains.damping *= std::sqrt(o.gain);
        if (!o.fixed_gains.stiffness.isZero())
            s.gains = o.fixed_gains;
        SafetyLimits limits;
        limits.max_force = 20.0;
        OutputGate gate(limits, device->kinematics());
        gate.set_homed(true);
        session = std::make_unique<Session>(s, model, gate, *device, Pose(0.0, 0.01 + o.distance, 0.0));
        session->take(*floor_of(1));
    }
    std::unique_ptr<SimulatedPantograph> device;
    std::unique_ptr<Session> session;
};

/// What becomes of four seconds of it.
struct Experiment1Outcome {
    /// From the first touch until the contact force stays within 0.2 N of the push, s; negative when it never
    /// does.
    double settling{-1.0};
    /// Peak to peak in the last second: contact force (N) and handle (m).
    double force_swing{0.0};
    double handle_swing{0.0};
    /// Created by the controller, J.
    double energy{0.0};
    /// Coupling, N/m.
    double stiffness{0.0};
    /// Largest force that left the gate, N.
    double largest_force{0.0};
};

inline Experiment1Outcome outcome_of(const Experiment1Options& options) {
    Experiment1 e(options);
    const int steps = static_cast<int>(4.0 * options.rate_hz);
    double touch = -1.0;
    double unsettled = 0.0;
    double force[2] = {1e300, -1e300};
    double handle[2] = {1e300, -1e300};
    for (int i = 0; i < steps; ++i) {
        e.session->step();
        const HapticReport& r = e.session->report();
        if (touch < 0.0 && r.contacts > 0)
            touch = r.time;
        if (std::abs(r.contact.y() - options.push) > 0.2)
            unsettled = r.time;
        if (r.time <= 3.0)
            continue;
        const double y = e.device->true_pose().y();
        force[0] = std::min(force[0], r.contact.y());
        force[1] = std::max(force[1], r.contact.y());
        handle[0] = std::min(handle[0], y);
        handle[1] = std::max(handle[1], y);
    }
    Experiment1Outcome o;
    o.settling = unsettled < 3.0 ? unsettled - touch : -1.0;
    o.force_swing = force[1] - force[0];
    o.handle_swing = handle[1] - handle[0];
    o.energy = e.session->report().energy_injected;
    o.stiffness = e.session->gains().stiffness.y();
    o.largest_force = e.session->report().run.max_force;
    return o;
}

} // namespace haptics::shared
