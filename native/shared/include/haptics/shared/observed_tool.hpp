#pragma once
/// A rectangular tool in front of the paper's wall, held through a device whose mass the controller may have
/// wrong and whose hand force it has to observe.

#include <haptics/core/control/session.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <memory>

namespace haptics::shared {

/// A device with another mass than it says, and that can fall silent.
class MisjudgedDevice final : public DevicePort {
  public:
    MisjudgedDevice(SimulatedPantograph& device, double ratio)
        : device_(device)
        , ratio_(ratio) {}
    bool read(DeviceReading& reading) override { return !silent_ && device_.read(reading); }
    void write(const Wrench& force) override { device_.write(force); }
    void advance(double dt) override { device_.advance(dt); }
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override {
        return ratio_ * device_.handle_mass(pose);
    }
    [[nodiscard]] int freedoms() const override { return device_.freedoms(); }
    /// Gives no sample from now on.
    void silence() { silent_ = true; }

  private:
    SimulatedPantograph& device_;
    bool silent_{false};
    double ratio_;
};

struct ObservedToolOptions {
    double rate_hz{1000.0};
    double tool_mass{0.3};
    /// Mass that the controller assumes over the true one.
    double mass_ratio{1.0};
    Coupling coupling{Coupling::four_channel};
    HandForce hand_force{HandForce::combined};
    double hidden_inertia{0.0};
    Integrator integrator{Integrator::linearly_implicit};
    double encoder{10e-6};
    int delay_steps{1};
    /// Dry friction of the device, N.
    double coulomb{0.0};
    bool observer{true};
    bool passivity{false};
    double noise{0.05};
    int velocity_window{0};
    /// Distance from tool to wall at the start, m, stiffness of the wall, N/m, its damping, N s/m.
    double distance{0.005};
    double wall{15000.0};
    double wall_damping{20.0};
    Vec2 gravity{0.0, 0.0};
    CouplingGains gains;
    SimulatedHandOptions hand{pushing_hand(Wrench(0.0, -2.0, 0.0), 0.5)};
};

struct ObservedTool {
    explicit ObservedTool(const ObservedToolOptions& o) {
        SimulatedPantographOptions d;
        d.mass = 0.3;
        d.inertia = 3e-4;
        d.viscous_friction = 1.0;
        d.coulomb_friction = o.coulomb;
        d.encoder_model = o.encoder > 0.0 ? EncoderModel::handle : EncoderModel::exact;
        d.encoder_resolution = Vec3(o.encoder, o.encoder, 10.0 * o.encoder);
        d.command_delay_steps = o.delay_steps;
        d.limit_motors = false;
        d.sub_step = 1e-4;
        d.hand = o.hand;
        device = std::make_unique<SimulatedPantograph>(d);
        port = std::make_unique<MisjudgedDevice>(*device, o.mass_ratio);
        Model model = box_tool(o.tool_mass);
        model.settings.integrator = o.integrator;
        SessionSettings s;
        s.step = 1.0 / o.rate_hz;
        s.coupling = o.coupling;
        s.hand_force = o.hand_force;
        s.hidden_inertia = o.hidden_inertia;
        s.gains = o.gains;
        s.reading_error = Vec3(0.5 * o.encoder, 0.5 * o.encoder, 5.0 * o.encoder);
        s.observer.enabled = o.observer;
        s.observer.delay = o.delay_steps * s.step;
        s.observer.noise = o.noise;
        s.passivity_control = o.passivity;
        s.velocity_window = o.velocity_window;
        SafetyLimits limits;
        limits.max_force = 30.0;
        OutputGate gate(limits, device->kinematics());
        gate.set_homed(true);
        session = std::make_unique<Session>(s, model, gate, *port, Pose(0.0, 0.01 + o.distance, 0.0));
        auto scene = floor_of(1);
        scene->gravity = o.gravity;
        scene->bodies.body[0].surface.stiffness = o.wall;
        scene->bodies.body[0].surface.damping = o.wall_damping;
        session->take(*scene);
    }
    std::unique_ptr<SimulatedPantograph> device;
    std::unique_ptr<MisjudgedDevice> port;
    std::unique_ptr<Session> session;
};

} // namespace haptics::shared
