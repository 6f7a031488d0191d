#pragma once
/// Experiment 2 of the paper: a grounded linkage of three links, held by its third link, imposes its topology
/// on the hand. The hand swings the linkage's joints to and fro; it pulls the handle through its own
/// stiffness.

#include <haptics/core/dynamics/jacobian.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/mass_matrix.hpp>
#include <haptics/shared/linkage_tools.hpp>
#include <haptics/shared/observed_tool.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptics::shared {

struct Experiment2Options {
    double rate_hz{1000.0};
    /// Swings per second and fastest speed of the grip, m/s.
    double frequency{2.0};
    double speed{0.9};
    double seconds{3.0};
    HandForce hand_force{HandForce::transparent};
    Coupling coupling{Coupling::four_channel};
    double hidden_inertia{0.9};
    /// False: the hand force is measured, the reading exact and nothing is late.
    bool observer{false};
    /// True mass of handle and hand, kg; their inertias are a thousandth of the first, and, kg m^2, the
    /// other.
    double device_mass{0.3};
    double hand_mass{0.15};
    double hand_inertia{1e-4};
    /// Mass that the controller assumes over the true one, and the error its design has to bear.
    double mass_ratio{1.0};
    double mass_error{0.25};
    double encoder{1e-6};
    int delay_steps{1};
    double noise{0.05};
    /// N s/m and, times 1e-3, N m s/rad.
    double friction{0.0};
    bool passivity{false};
    /// A wall beside links 1 and 2 and an object before link 3.
    bool obstacles{false};
};

inline LinkageVector experiment2_start() {
    LinkageVector q(3);
    q << 0.5, -0.9, 0.8;
    return q;
}

/// Where the grip is for the joints `q`.
inline Pose experiment2_grip(const Model& model, const LinkageVector& q) {
    LinkageData data;
    reset(model.tool.linkage, data);
    data.position = q;
    update_kinematics(model.tool.linkage, data);
    return link_center_pose(model.tool.linkage, data, model.tool.grip.link);
}

inline Model experiment2_linkage() {
    Model model = linkage_tool(arm());
    model.tool.grip = Grip{2, Vec2::Zero(), true};
    return model;
}

/// The hand: 1000 N/m; its wish rests for a second, then swings.
inline SimulatedHandOptions experiment2_hand(const Experiment2Options& o) {
    const Model model = experiment2_linkage();
    const LinkageVector start = experiment2_start();
    LinkageVector swing(3);
    swing << 1.0, -0.5, 0.4;
    const Pose from = experiment2_grip(model, start);
    const auto at = [&](double angle) {
        return Pose(experiment2_grip(model, LinkageVector(start + angle * swing)) - from);
    };
    const double w = 2.0 * std::numbers::pi * o.frequency;
    // of the joints, so that the grip reaches `speed`
    const double lever = (at(1e-6) - at(-1e-6)).head<2>().norm() / 2e-6;
    const double amplitude = o.speed / (lever * w);
    std::vector<HandTarget> path{{0.0, Pose::Zero()}, {1.0, Pose::Zero()}};
    constexpr double k_grain = 0.002;
    for (int i = 1; i * k_grain <= o.seconds; ++i) {
        const double t = i * k_grain;
        // grows over the first swing
        const double u = std::min(1.0, t * o.frequency);
        path.push_back({1.0 + t, at(amplitude * u * u * (3.0 - 2.0 * u) * std::sin(w * t))});
    }
    SimulatedHandOptions hand = path_hand(std::move(path));
    hand.mass = o.hand_mass;
    hand.inertia = o.hand_inertia;
    hand.rotation_stiffness = 2.0;
    hand.max_force = 60.0;
    hand.max_torque = 2.0;
    return hand;
}

inline std::unique_ptr<Neighborhood> experiment2_obstacles() {
    auto n = empty_world();
    add_body(n->bodies, 100, BodyKind::fixed, paper_surface(), Pose(0.0, -0.01, 0.2));
    add_piece(n->bodies, make_box(Vec2(0.06, 0.1), Vec2(0.24, 0.07)));
    Body& object = n->bodies.body[static_cast<std::size_t>(
        add_body(n->bodies, 200, BodyKind::movable, paper_surface(), Pose(0.25, -0.04, 0.0)))];
    object.mass = 0.1;
    object.inertia = 0.1 * 0.02 * 0.02 / 6.0;
    add_piece(n->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    return n;
}

/// The same hand on the linkage without a device: explicit midpoint steps of 20 us.
class IdealLinkage {
  public:
    explicit IdealLinkage(const Experiment2Options& o)
        : model_(experiment2_linkage())
        , options_(experiment2_hand(o))
        // its damping is critical with the device
        , hand_(options_, options_.mass + o.device_mass, options_.inertia + k_lever * o.device_mass,
                Pose::Zero()) {
        reset(model_.tool.linkage, data_);
        data_.position = experiment2_start();
        data_.velocity.setZero(3);
        update_kinematics(model_.tool.linkage, data_);
        from_ = link_center_pose(model_.tool.linkage, data_, 2);
    }
    /// Inertia of the device over its mass, m^2.
    static constexpr double k_lever = 1e-3;

    void advance(double dt) {
        const int parts = std::max(1, static_cast<int>(std::ceil(dt / 20e-6 - 1e-6)));
        const double h = dt / parts;
        for (int i = 0; i < parts; ++i) {
            const LinkageVector q = data_.position;
            const LinkageVector v = data_.velocity;
            hand_.advance(time_);
            const LinkageVector a = acceleration();
            data_.position = q + 0.5 * h * v;
            data_.velocity = v + 0.5 * h * a;
            hand_.advance(time_ + 0.5 * h);
            const LinkageVector middle = acceleration();
            data_.position = q + h * (v + 0.5 * h * a);
            data_.velocity = v + h * middle;
            time_ += h;
        }
        update_kinematics(model_.tool.linkage, data_);
    }
    /// Of the grip, from where it began.
    [[nodiscard]] Pose moved() const { return link_center_pose(model_.tool.linkage, data_, 2) - from_; }
    [[nodiscard]] const LinkageVector& configuration() const { return data_.position; }

  private:
    LinkageVector acceleration() {
        const LinkageModel& linkage = model_.tool.linkage;
        update_kinematics(linkage, data_);
        const Pose grip = link_center_pose(linkage, data_, 2);
        PointJacobian j;
        point_jacobian(linkage, data_, 2, grip.head<2>(), j);
        const Vec3 carried(options_.mass, options_.mass, options_.inertia);
        Wrench force = hand_.force(grip - from_, j * data_.velocity);
        force -= carried.cwiseProduct(point_bias(linkage, data_, 2, grip.head<2>()));
        LinkageMatrix mass;
        mass_matrix(linkage, data_, mass);
        LinkageVector bias;
        bias_forces(linkage, data_, bias);
        const Mat3 all = mass + j.transpose() * carried.asDiagonal() * j;
        return all.inverse() * (j.transpose() * force - bias);
    }

    Model model_;
    SimulatedHandOptions options_;
    SimulatedHand hand_;
    LinkageData data_;
    Pose from_;
    double time_{0.0};
};

struct Experiment2 {
    explicit Experiment2(const Experiment2Options& o) {
        SimulatedPantographOptions d;
        d.mass = o.device_mass;
        d.inertia = IdealLinkage::k_lever * o.device_mass;
        d.viscous_friction = o.friction;
        d.rotation_viscous_friction = 1e-3 * o.friction;
        d.encoder_model = o.observer ? EncoderModel::handle : EncoderModel::exact;
        d.encoder_resolution = Vec3(o.encoder, o.encoder, 10.0 * o.encoder);
        d.command_delay_steps = o.observer ? o.delay_steps : 0;
        d.measures_force = !o.observer;
        d.measures_velocity = !o.observer;
        d.limit_motors = false;
        d.bounded = false;
        d.hand = experiment2_hand(o);
        device = std::make_unique<SimulatedPantograph>(d);
        port = std::make_unique<MisjudgedDevice>(*device, o.mass_ratio);
        Model model = experiment2_linkage();
        SessionSettings s;
        s.step = 1.0 / o.rate_hz;
        s.coupling = o.coupling;
        s.hand_force = o.hand_force;
        s.hidden_inertia = o.hidden_inertia;
        s.passivity_control = o.passivity;
        const double error = o.observer ? 0.5 * o.encoder : 0.0;
        s.reading_error = Vec3(error, error, 10.0 * error);
        s.observer.enabled = o.observer;
        s.observer.delay = o.delay_steps * s.step;
        s.observer.noise = o.noise;
        s.observer.mass_error = o.mass_error;
        SafetyLimits limits;
        limits.max_force = 40.0;
        limits.max_torque = 2.0;
        limits.max_speed = 4.0;
        OutputGate gate(limits);
        gate.set_homed(true);
        session = std::make_unique<Session>(s, model, gate, *port, experiment2_start());
        session->take(o.obstacles ? *experiment2_obstacles() : *empty_world());
    }
    std::unique_ptr<SimulatedPantograph> device;
    std::unique_ptr<MisjudgedDevice> port;
    std::unique_ptr<Session> session;
};

struct Experiment2Outcome {
    /// Between handle and grip of the proxy at the same time, m: peak and root mean square while it swings.
    double peak{0.0};
    double mean{0.0};
    /// Between the handle and the grip of the linkage without a device, m, root mean square.
    double motion{0.0};
    double fastest{0.0};
    double largest_contact{0.0};
    double energy{0.0};
    Fault faults{Fault::none};
    HiddenInertia hidden;
    double stiffness{0.0};
};

/// Runs it; `write(report, handle, error)` sees every step of the swing.
template <class Write>
Experiment2Outcome run_experiment2(const Experiment2Options& o, const Write& write) {
    Experiment2 e(o);
    IdealLinkage ideal(o);
    Experiment2Outcome r;
    const double h = 1.0 / o.rate_hz;
    const Pose from = e.session->report().grip;
    const int rest = static_cast<int>(o.rate_hz);
    const int n = rest + static_cast<int>(o.seconds * o.rate_hz);
    // an observed handle and the proxy are ahead of the device by the delay
    const int ahead = o.observer ? o.delay_steps : 0;
    std::vector<Pose> grips;
    int count = 0;
    for (int i = 0; i < n; ++i) {
        e.session->step();
        ideal.advance(h);
        const HapticReport& now = e.session->report();
        grips.push_back(now.grip);
        if (i < rest + ahead)
            continue;
        const Pose master = from + e.device->true_pose();
        const double off = (grips[static_cast<std::size_t>(i - ahead)] - master).head<2>().norm();
        write(now, master, off);
        r.peak = std::max(r.peak, off);
        r.mean += off * off;
        r.motion += (e.device->true_pose() - ideal.moved()).head<2>().squaredNorm();
        r.fastest = std::max(r.fastest, e.device->true_twist().head<2>().norm());
        r.largest_contact = std::max(r.largest_contact, now.contact.head<2>().norm());
        ++count;
    }
    r.mean = std::sqrt(r.mean / count);
    r.motion = std::sqrt(r.motion / count);
    r.energy = e.session->report().energy_injected;
    r.faults = e.session->report().faults;
    r.hidden = e.session->hidden_inertia();
    r.stiffness = e.session->gains().stiffness.x();
    return r;
}

inline Experiment2Outcome run_experiment2(const Experiment2Options& o) {
    return run_experiment2(o, [](const HapticReport&, const Pose&, double) {});
}

} // namespace haptics::shared
