// A linkage in a runner: what the report tells of it, and taking hold elsewhere while it runs.

#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/realtime/haptic_runner.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <support/realtime_guard.hpp>
#include <thread>

using namespace haptics;
using haptics::testing::RealtimeGuard;

namespace {

LinkageVector bent() {
    LinkageVector start(3);
    start << 0.4, 0.7, -0.3;
    return start;
}

} // namespace

TEST_CASE("the report of a linkage holds its coordinates and the held link") {
    Model model = shared::linkage_tool(shared::chain(3));
    model.tool.grip = {2, Vec2(0.05, 0.0), false};
    shared::HeldTool tool(model, bent(), SimulatedHandOptions{});
    HapticRunner runner(std::move(tool.session), nullptr);
    runner.neighborhood() = *shared::empty_world();
    runner.publish();
    runner.advance(0.2);
    const HapticReport& r = runner.latest_report();
    REQUIRE(r.freedoms == 3);
    CHECK(r.held_link == 2);
    LinkageData data;
    reset(model.tool.linkage, data);
    for (int i = 0; i < 3; ++i) {
        data.position(i) = r.configuration[static_cast<std::size_t>(i)];
        CHECK(data.position(i) == doctest::Approx(bent()(i)).epsilon(1e-3));
    }
    update_kinematics(model.tool.linkage, data);
    // the coordinates lead to the pose that the report has of the held link
    CHECK((link_center_pose(model.tool.linkage, data, 2) - r.proxy).norm() < 1e-12);
}

TEST_CASE("grabbing another link through the runner moves the grip there and starts without force") {
    Model model = shared::linkage_tool(shared::chain(3));
    model.tool.grip = {2, Vec2(0.05, 0.0), false};
    SimulatedHandOptions hand;
    hand.kind = HandKind::constant_force;
    hand.force = Vec3(0.0, 0.0, 0.0);
    shared::HeldTool tool(model, bent(), hand);
    HapticRunner runner(std::move(tool.session), nullptr);
    runner.neighborhood() = *shared::empty_world();
    runner.publish();
    runner.advance(0.2);
    runner.grab({0, Vec2(0.01, 0.0), false});
    double most = 0.0;
    for (int i = 0; i < 300; ++i) {
        runner.advance(0.001);
        most = std::max(most, runner.latest_report().force.head<2>().norm());
    }
    const HapticReport& r = runner.latest_report();
    CHECK(r.held_link == 0);
    CHECK(r.held);
    CHECK((r.grip.head<2>() - Vec2(0.06, 0.0).norm() * Vec2(std::cos(r.proxy.z()), std::sin(r.proxy.z())))
              .norm() < 1e-9);
    CHECK(most < 0.01);
}

namespace {

// a box that leans on the first link of a linkage beside it
struct TwoRunners {
    TwoRunners() {
        const Model tool = shared::box_tool(0.3);
        SimulatedHandOptions hand;
        hand.kind = HandKind::constant_force;
        hand.force = Vec3(0.0, -1.0, 0.0);
        hand.start_time = 0.3;
        LinkageVector start(3);
        start << 0.06, 0.0155, 0.0;
        held = std::make_unique<shared::HeldTool>(tool, start, hand);
        LinkageSpec spec = shared::chain(3);
        spec.links[0].joint.lower_limit = -0.001;
        const Model arm = shared::linkage_tool(spec);
        SessionSettings free;
        free.hold_at_start = false;
        free.coupling = Coupling::virtual_coupling;
        beside =
            std::make_unique<shared::HeldTool>(arm, LinkageVector::Zero(3), SimulatedHandOptions{}, free);
        host = std::make_unique<HapticRunner>(std::move(held->session), nullptr);
        guest = std::make_unique<HapticRunner>(std::move(beside->session), nullptr);
        for (int i = 0; i < 3; ++i) {
            Body& b = n.bodies.body[static_cast<std::size_t>(
                shared::add_body(n.bodies, static_cast<std::uint64_t>(i + 1), BodyKind::movable,
                                 shared::paper_surface(), Pose(0.05 + 0.1 * i, 0.0, 0.0)))];
            b.mass = 0.1;
            b.inertia = 1e-4;
            b.jointed = true;
            b.linkage = 9;
            b.link = i;
            b.mobility = Mat3::Identity();
            shared::add_piece(n.bodies, make_box(Vec2::Zero(), Vec2(0.1, 0.01)));
        }
        publish(1, 0.0);
    }
    void publish(std::uint64_t sequence, double time) {
        n.sequence = sequence;
        n.time = time;
        host->neighborhood() = n;
        host->publish();
        guest->neighborhood() = *shared::empty_world();
        guest->neighborhood().sequence = sequence;
        guest->neighborhood().time = n.time;
        guest->publish();
    }
    Neighborhood n;
    std::unique_ptr<shared::HeldTool> held;
    std::unique_ptr<shared::HeldTool> beside;
    std::unique_ptr<HapticRunner> host;
    std::unique_ptr<HapticRunner> guest;
};

} // namespace

TEST_CASE("a linkage beside a tool is stepped with it, and neither allocates, locks nor blocks") {
    TwoRunners two;
    REQUIRE(two.host->attach(*two.guest, 9));
    LockstepClock clock(1000.0);
    RealtimeGuard guard;
    for (int tick = 1; tick <= 120; ++tick) {
        two.publish(static_cast<std::uint64_t>(tick) + 1, static_cast<double>(clock.scene_ns()) * 1e-9);
        for (int left = clock.begin_tick(1.0 / 60.0); left > 0; --left) {
            const StepTime time = clock.next();
            guard.begin();
            two.host->step(time);
            guard.end();
        }
    }
    CHECK_MESSAGE(guard.violations() == 0, guard.first());
    CHECK(two.guest->latest_report().step == two.host->latest_report().step);
    // the first joint leans on its stop, the force of the hand is back
    CHECK(two.guest->latest_report().configuration[0] < -0.001);
    CHECK(two.host->latest_report().contact.y() == doctest::Approx(1.0).epsilon(0.05));
}

TEST_CASE("what was detached while the loop runs is stepped no more") {
    TwoRunners two;
    LoopOptions options;
    options.priority = 0;
    options.lock_memory = false;
    options.hold_cpu_latency = false;
    REQUIRE(two.host->start(options));
    for (int i = 0; i < 100; ++i) {
        REQUIRE(two.host->attach(*two.guest, 9));
        std::this_thread::sleep_for(std::chrono::microseconds(700 + 37 * i));
        two.host->detach(*two.guest);
        // the owner may touch it now
        const std::uint64_t steps = two.guest->session().report().step;
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        REQUIRE(two.guest->session().report().step == steps);
    }
    CHECK(two.guest->session().report().step > 0);
    two.host->stop();
}

TEST_CASE("at most so many linkages run beside a tool") {
    TwoRunners two;
    for (int i = 0; i < HapticRunner::k_max_guests; ++i)
        CHECK(two.host->attach(*two.guest, static_cast<std::uint64_t>(i + 1)));
    CHECK_FALSE(two.host->attach(*two.guest, 99));
    two.host->detach(*two.guest);
    CHECK(two.host->attach(*two.guest, 99));
}

namespace {

// a rod that floats beside a tool
std::unique_ptr<HapticRunner> floating_rod(const Pose& at, double speed) {
    const Model model = shared::linkage_tool(shared::chain(1, BaseKind::floating));
    SessionSettings free;
    free.hold_at_start = false;
    free.coupling = Coupling::virtual_coupling;
    shared::HeldTool rod(model, at, SimulatedHandOptions{}, free);
    rod.session->set_rates(Vec3(0.0, speed, 0.0));
    static std::vector<std::unique_ptr<SimulatedPantograph>> devices;
    devices.push_back(std::move(rod.device));
    return std::make_unique<HapticRunner>(std::move(rod.session), nullptr);
}

double speed_of(HapticRunner& rod) {
    return rod.latest_report().configuration_rate[1];
}

} // namespace

TEST_CASE("two linkages beside a tool hit each other once, in whichever order they joined") {
    for (const bool swapped : {false, true}) {
        CAPTURE(swapped);
        shared::HeldTool held(shared::box_tool(0.3), Pose(1.0, 1.0, 0.0), SimulatedHandOptions{});
        HapticRunner host(std::move(held.session), nullptr);
        // equal rods, one comes down on the other: without loss they exchange their speeds
        auto first = floating_rod(Pose(0.0, 0.02, 0.0), -0.5);
        auto second = floating_rod(Pose(0.0, 0.0, 0.0), 0.0);
        REQUIRE(host.attach(swapped ? *second : *first, swapped ? 8 : 7));
        REQUIRE(host.attach(swapped ? *first : *second, swapped ? 7 : 8));
        Neighborhood n;
        n.sequence = 1;
        Surface surface = shared::paper_surface();
        surface.restitution = 1.0;
        Body& b = n.bodies.body[static_cast<std::size_t>(
            shared::add_body(n.bodies, 1, BodyKind::movable, surface, Pose(0.05, 0.0, 0.0)))];
        b.mass = 0.1;
        b.inertia = 0.1 * 0.1 * 0.1 / 12.0;
        b.jointed = true;
        b.linkage = 8;
        b.mobility = Mat3::Identity();
        shared::add_piece(n.bodies, make_box(Vec2::Zero(), Vec2(0.1, 0.01)));
        first->neighborhood() = n;
        first->publish();
        second->neighborhood() = *shared::empty_world();
        second->publish();
        host.neighborhood() = *shared::empty_world();
        host.publish();
        LockstepClock clock(1000.0);
        RealtimeGuard guard;
        for (int left = clock.begin_tick(0.05); left > 0; --left) {
            const StepTime time = clock.next();
            guard.begin();
            host.step(time);
            guard.end();
        }
        CHECK_MESSAGE(guard.violations() == 0, guard.first());
        CHECK(speed_of(*first) == doctest::Approx(0.0).epsilon(0.005));
        CHECK(speed_of(*second) == doctest::Approx(-0.5).epsilon(0.01));
    }
}
