// Extreme cases with a simulated device in the loop: nothing that leaves the output gate may be above its
// limits or not finite, whatever comes in.

#include <haptics/core/control/session.hpp>
#include <haptics/core/local_model/validate.hpp>
#include <haptics/realtime/haptic_runner.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "extreme.hpp"
#include "tables.hpp"

namespace haptics::report {

namespace {

// the limits of shared::HeldTool
constexpr double k_max_force = 20.0;
constexpr double k_max_torque = 1.0;
constexpr double k_pi = std::numbers::pi;

// what comes between session and device: breaks readings, and watches commands
class Between final : public DevicePort {
  public:
    explicit Between(DevicePort& device)
        : device_(device) {}
    bool read(DeviceReading& reading) override {
        const bool got = device_.read(reading);
        if (spoil)
            spoil(reading);
        return got;
    }
    void write(const Wrench& force) override {
        not_finite += force.allFinite() ? 0 : 1;
        largest =
            std::max({largest, force.head<2>().norm() / k_max_force, std::abs(force.z()) / k_max_torque});
        device_.write(force.allFinite() ? force : Wrench(Wrench::Zero()));
    }
    void advance(double dt) override { device_.advance(dt); }
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override { return device_.handle_mass(pose); }
    [[nodiscard]] int freedoms() const override { return device_.freedoms(); }

    std::function<void(DeviceReading&)> spoil;
    long not_finite{0};
    /// Over the limits.
    double largest{0.0};

  private:
    DevicePort& device_;
};

SimulatedPantographOptions device_with(const SimulatedHandOptions& hand) {
    SimulatedPantographOptions d;
    d.mass = 0.3;
    d.inertia = 3e-4;
    d.viscous_friction = 1.0;
    d.encoder_model = EncoderModel::handle;
    d.measures_force = true;
    d.limit_motors = false;
    d.bounded = false;
    d.sub_step = 2e-4;
    d.hand = hand;
    return d;
}

struct Loop {
    Loop(const Model& model, const LinkageVector& start, const SimulatedHandOptions& hand,
         const SessionSettings& settings = {})
        : device(device_with(hand))
        , between(device) {
        SafetyLimits limits;
        limits.max_force = k_max_force;
        limits.max_torque = k_max_torque;
        OutputGate gate(limits);
        gate.set_homed(true);
        session = std::make_unique<Session>(settings, model, gate, between, start);
    }
    void go(double seconds) {
        const double step = session->settings().step;
        for (auto left = static_cast<long>(seconds / step + 0.5); left > 0; --left) {
            session->step();
            const HapticReport& r = session->report();
            const bool finite = r.proxy.allFinite() && r.velocity.allFinite() && r.force.allFinite() &&
                                r.contact.allFinite() && r.coupling.allFinite();
            not_finite += finite ? 0 : 1;
            fastest = std::max(fastest, device.true_twist().head<2>().norm());
        }
    }
    [[nodiscard]] ExtremeResult result(double value, std::string note = {}) const {
        return {value, not_finite + between.not_finite, between.largest, std::move(note)};
    }
    [[nodiscard]] std::string faults() const {
        std::string text;
        for (int bit = 0; bit < k_fault_count; ++bit)
            if (has(session->report().faults, static_cast<Fault>(1U << static_cast<unsigned>(bit))))
                text += (text.empty() ? "" : "; ") + std::string(describe_fault(bit));
        return text;
    }
    SimulatedPantograph device;
    Between between;
    std::unique_ptr<Session> session;
    long not_finite{0};
    double fastest{0.0};
};

const Pose k_above(0.0, 0.015, 0.0);

SimulatedHandOptions pressing(double x = 0.0, double y = -2.0) {
    return pushing_hand(Wrench(x, y, 0.0), 0.5);
}

// an arm of three links held at its tip and pushed with 2 N in the direction in which it cannot go
ExtremeResult singular(const LinkageVector& q, double sign, bool pose) {
    Model model = shared::linkage_tool(shared::arm());
    model.tool.grip = Grip{2, Vec2(0.05, 0.0), pose};
    Loop loop(model, q, pressing(2.0 * sign, 0.0));
    loop.session->take(*shared::empty_world());
    loop.go(3.0);
    // folded and held by a point alone it gives way sideways: the equilibrium is unstable
    if (!pose && q.norm() > 0.0)
        return loop.result(
            loop.between.largest,
            "no steady force to compare with: it gives way sideways, swings round and meets the "
            "clamp on the way");
    return loop.result(std::abs(loop.session->report().force.x() / (-2.0 * sign) - 1.0), loop.faults());
}

ExtremeResult held_whip() {
    Model model = shared::linkage_tool(shared::chain(48));
    std::vector<HandTarget> path;
    for (int i = 0; i <= 40; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / 40.0;
        HandTarget t;
        t.time_s = 1.0 + 0.25 * i / 40.0;
        t.pose = Pose(0.01 * std::sin(turn), 0.01 * (std::cos(turn) - 1.0), 0.0);
        path.push_back(t);
    }
    model.tool.grip = Grip{0, Vec2(0.05, 0.0), false};
    Loop loop(model, LinkageVector::Constant(48, 0.05), path_hand(path, PathInterpolation::smooth, true));
    loop.session->take(*shared::empty_world());
    loop.go(3.0);
    return loop.result(loop.between.largest, loop.faults());
}

ExtremeResult deep_start_held() {
    Loop loop(shared::box_tool(), Pose(0.0, -0.05, 0.0), pressing());
    auto scene = shared::empty_world();
    shared::add_body(scene->bodies, 1, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
    shared::add_piece(scene->bodies, make_half_plane(Vec2::Zero(), Vec2(0.0, 1.0)));
    loop.session->take(*scene);
    loop.go(3.0);
    return loop.result(loop.between.largest, loop.faults());
}

ExtremeResult hard_wall_held(double stiffness, double damping) {
    Loop loop(shared::box_tool(), k_above, pressing());
    auto scene = shared::floor_of(1);
    scene->bodies.body[0].surface.stiffness = stiffness;
    scene->bodies.body[0].surface.damping = damping;
    loop.session->take(*scene);
    loop.go(3.0);
    // a count of the encoder to and fro is 0.3 N in the damper: one instant says nothing of a steady force
    double sum = 0.0;
    constexpr int k_steps = 1000;
    for (int i = 0; i < k_steps; ++i) {
        loop.go(loop.session->settings().step);
        sum += loop.session->report().force.y();
    }
    return loop.result(std::abs(sum / k_steps / 2.0 - 1.0), loop.faults());
}

// the floor jumps 30 mm up into the tool and back, six times a second
ExtremeResult teleports(BodyKind kind) {
    Loop loop(shared::box_tool(), k_above, mouse_hand());
    auto scene = shared::floor_of(1);
    scene->bodies.body[0].kind = kind;
    for (int tick = 0; tick < 300; ++tick) {
        scene->bodies.body[0].pose.y() = tick > 60 && tick / 5 % 2 == 1 ? 0.03 : 0.0;
        ++scene->sequence;
        scene->time = static_cast<double>(loop.session->report().step) * 1e-3;
        loop.session->take(*scene);
        loop.go(1.0 / 60.0);
    }
    return loop.result(loop.fastest, loop.faults());
}

// the scene says nothing for two seconds
ExtremeResult frozen() {
    Loop loop(shared::box_tool(), k_above, pressing());
    const auto floor = shared::floor_of(1);
    HapticRunner runner(std::move(loop.session), nullptr);
    double before = 0.0;
    for (int tick = 0; tick < 240; ++tick) {
        if (tick < 120) {
            runner.neighborhood() = *floor;
            runner.neighborhood().sequence = static_cast<std::uint64_t>(tick) + 1;
            runner.neighborhood().time = runner.now();
            runner.publish();
        }
        runner.advance(1.0 / 60.0);
        before = tick == 119 ? runner.latest_report().force.y() : before;
    }
    ExtremeResult r;
    r.value = runner.latest_report().force.norm();
    r.not_finite = loop.between.not_finite;
    r.force_over_limit = loop.between.largest;
    if (!(before > 1.0)) {
        r.value = k_lost;
        r.note = "there was no force to begin with";
    }
    return r;
}

constexpr double k_bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                            1e308};

// broken readings for 20 ms under a push onto the wall: what is not finite afterwards
ExtremeResult broken_reading(const std::function<void(DeviceReading&, double)>& spoil) {
    ExtremeResult all{0.0, 0, 0.0, ""};
    for (const double bad : k_bad) {
        Loop loop(shared::box_tool(), k_above, pressing());
        loop.session->take(*shared::floor_of(1));
        loop.go(2.0);
        loop.between.spoil = [&](DeviceReading& r) { spoil(r, bad); };
        loop.go(0.02);
        loop.between.spoil = nullptr;
        loop.go(0.5);
        all.value += static_cast<double>(loop.between.not_finite);
        all.not_finite += loop.not_finite;
        all.force_over_limit = std::max(all.force_over_limit, loop.between.largest);
        all.note += (all.note.empty() ? "" : " / ") + (loop.faults().empty() ? "no fault" : loop.faults());
    }
    return all;
}

// a broken snapshot for one tick under a push onto the wall
ExtremeResult broken_snapshot(const std::function<void(Neighborhood&, double)>& spoil) {
    ExtremeResult all{0.0, 0, 0.0, ""};
    for (const double bad : k_bad) {
        Loop loop(shared::box_tool(), k_above, pressing());
        auto scene = shared::floor_of(1);
        const auto tick = [&](const Neighborhood& now) {
            ++scene->sequence;
            auto next = std::make_unique<Neighborhood>(now);
            next->sequence = scene->sequence;
            loop.session->take(*next);
            loop.go(0.02);
        };
        loop.session->take(*scene);
        loop.go(2.0);
        auto broken = std::make_unique<Neighborhood>(*scene);
        spoil(*broken, bad);
        tick(*broken);
        for (int i = 0; i < 10; ++i)
            tick(*scene);
        all.value += static_cast<double>(loop.between.not_finite);
        all.not_finite += loop.not_finite;
        all.force_over_limit = std::max(all.force_over_limit, loop.between.largest);
        all.note += (all.note.empty() ? "" : " / ") + (loop.faults().empty() ? "no fault" : loop.faults());
    }
    return all;
}

// settings that are not numbers and that a check lets pass
ExtremeResult broken_settings() {
    int accepted = 0;
    int asked = 0;
    const auto look = [&](bool refused) {
        ++asked;
        accepted += refused ? 0 : 1;
    };
    const double nan = k_bad[0];
    for (double Surface::* field : {&Surface::stiffness, &Surface::damping, &Surface::static_friction,
                                    &Surface::dynamic_friction, &Surface::restitution}) {
        Surface s = shared::paper_surface();
        s.*field = nan;
        look(!validate(s).empty());
    }
    for (double ToolModel::* field : {&ToolModel::mass, &ToolModel::inertia}) {
        Model m = shared::box_tool();
        m.tool.*field = nan;
        look(!validate(m).empty());
    }
    for (double LocalModelSettings::* field :
         {&LocalModelSettings::collision_speed, &LocalModelSettings::margin}) {
        Model m = shared::box_tool();
        m.settings.*field = nan;
        look(!validate(m).empty());
    }
    for (double SessionSettings::* field :
         {&SessionSettings::step, &SessionSettings::device_delay, &SessionSettings::device_patience}) {
        SessionSettings s;
        s.*field = nan;
        look(!validate(s).empty());
    }
    for (double SafetyLimits::* field :
         {&SafetyLimits::max_force, &SafetyLimits::max_torque, &SafetyLimits::force_slew,
          &SafetyLimits::torque_slew, &SafetyLimits::reference_mass, &SafetyLimits::max_speed,
          &SafetyLimits::max_energy, &SafetyLimits::ramp_time}) {
        SafetyLimits l;
        l.*field = nan;
        look(!validate(l).empty());
    }
    for (double SimulatedPantographOptions::* field :
         {&SimulatedPantographOptions::mass, &SimulatedPantographOptions::inertia,
          &SimulatedPantographOptions::viscous_friction, &SimulatedPantographOptions::command_delay,
          &SimulatedPantographOptions::sub_step}) {
        SimulatedPantographOptions o;
        o.*field = nan;
        look(!validate(o).empty());
    }
    return {static_cast<double>(accepted), 0, 0.0, std::to_string(asked) + " figures asked"};
}

} // namespace

void add_device_cases(std::vector<ExtremeCase>& cases) {
    const auto add = [&cases](std::string name, const char* figure, double bound,
                              std::function<ExtremeResult()> run) {
        cases.push_back({std::move(name), figure, bound, std::move(run)});
    };
    constexpr const char* k_share = "largest force over the gate's limit";
    for (const bool pose : {false, true}) {
        const std::string grip = pose ? ", held by pose" : ", held by a point";
        add("arm stretched straight, pushed outward with 2 N" + grip, "relative error of the force felt",
            0.01, [pose] { return singular(Vec3(0.0, 0.0, 0.0), 1.0, pose); });
        add("arm folded flat, pushed inward with 2 N" + grip + (pose ? "" : ": force stays within the limit"),
            pose ? "relative error of the force felt" : k_share, pose ? 0.01 : 1.0,
            [pose] { return singular(Vec3(0.0, k_pi, -k_pi), 1.0, pose); });
    }
    add("chain of 48 links whirled by its first link at 4 Hz", k_share, 1.0, held_whip);
    add("held tool starts deeper inside a wall than it is tall: force stays within the limit", k_share, 1.0,
        deep_start_held);
    for (const double stiffness : {15000.0, 1e12})
        for (const double damping : {20.0, 1e12})
            if (stiffness > 1e6 || damping > 1e6)
                add("2 N on a wall of " + std::string(stiffness > 1e6 ? "1e12" : "15000") + " N/m and " +
                        (damping > 1e6 ? "1e12" : "20") + " N s/m through the device",
                    "relative error of the mean force felt", 0.02,
                    [=] { return hard_wall_held(stiffness, damping); });
    add("a fixed floor teleports 30 mm into a held tool and back",
        "fastest handle, m/s (the gate faults at 2)", 2.0, [] { return teleports(BodyKind::fixed); });
    add("a moving floor teleports 30 mm into a held tool and back",
        "fastest handle, m/s (the gate faults at 2)", 2.0, [] { return teleports(BodyKind::kinematic); });
    add("the scene freezes for 2 s while the tool is pressed", "force that is left, N", 1e-12, frozen);

    constexpr const char* k_commands = "commands to the motors that are not finite";
    const auto reading = [&](const char* name, std::function<void(DeviceReading&, double)> spoil) {
        add(std::string("NaN, infinity and 1e308 in a reading's ") + name, k_commands, 0.0,
            [spoil = std::move(spoil)] { return broken_reading(spoil); });
    };
    reading("x", [](DeviceReading& r, double bad) { r.pose.x() = bad; });
    reading("angle", [](DeviceReading& r, double bad) { r.pose.z() = bad; });
    reading("velocity", [](DeviceReading& r, double bad) {
        r.has_velocity = true;
        r.velocity.y() = bad;
    });
    reading("hand force", [](DeviceReading& r, double bad) { r.hand_force.y() = bad; });
    reading("interval", [](DeviceReading& r, double bad) { r.interval = bad; });
    reading("age", [](DeviceReading& r, double bad) { r.age = bad; });
    reading("joint angles", [](DeviceReading& r, double bad) {
        r.has_angles = true;
        r.angles.setConstant(bad);
    });
    const auto snapshot = [&](const char* name, std::function<void(Neighborhood&, double)> spoil) {
        add(std::string("NaN, infinity and 1e308 in a snapshot's ") + name, k_commands, 0.0,
            [spoil = std::move(spoil)] { return broken_snapshot(spoil); });
    };
    snapshot("pose", [](Neighborhood& n, double bad) { n.bodies.body[0].pose.y() = bad; });
    snapshot("angle", [](Neighborhood& n, double bad) { n.bodies.body[0].pose.z() = bad; });
    snapshot("velocity", [](Neighborhood& n, double bad) {
        n.bodies.body[0].kind = BodyKind::kinematic;
        n.bodies.body[0].velocity.y() = bad;
    });
    snapshot("mass", [](Neighborhood& n, double bad) {
        n.bodies.body[0].kind = BodyKind::movable;
        n.bodies.body[0].mass = bad;
        n.bodies.body[0].inertia = bad;
    });
    snapshot("stiffness", [](Neighborhood& n, double bad) { n.bodies.body[0].surface.stiffness = bad; });
    snapshot("damping", [](Neighborhood& n, double bad) { n.bodies.body[0].surface.damping = bad; });
    snapshot("friction", [](Neighborhood& n, double bad) {
        n.bodies.body[0].surface.static_friction = n.bodies.body[0].surface.dynamic_friction = bad;
    });
    snapshot("shape", [](Neighborhood& n, double bad) { n.bodies.piece[0].convex.vertex[0].x() = bad; });
    snapshot("gravity", [](Neighborhood& n, double bad) { n.gravity.y() = bad; });
    snapshot("time", [](Neighborhood& n, double bad) { n.time = bad; });
    snapshot("tick", [](Neighborhood& n, double bad) { n.tick = bad; });
    add("settings that are not numbers", "settings that the checks accept", 0.0, broken_settings);
}

} // namespace haptics::report
