// Clutch, mapping and turn while the loop runs: nothing jumps, and the tool is where it was.

#include <haptics/core/control/placement.hpp>
#include <haptics/core/pantograph/presets.hpp>
#include <haptics/shared/observed_tool.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/random.hpp"

using namespace haptics;
using shared::ObservedTool;
using shared::ObservedToolOptions;

namespace {

// largest change of the force on the hand between two steps, N, and what is wanted besides
struct Watch {
    explicit Watch(ObservedTool& held)
        : tool(held) {}
    void step(int count) {
        for (int i = 0; i < count; ++i) {
            tool.session->step();
            const Vec2 now = tool.session->report().force.head<2>();
            if (started)
                jump = std::max(jump, (now - last).norm());
            last = now;
            started = true;
        }
    }
    ObservedTool& tool;
    Vec2 last{0.0, 0.0};
    double jump{0.0};
    bool started{false};
};

// presses on what is below with about `push` N, as far as its 500 N/m let it
SimulatedHandOptions pressing(double push) {
    SimulatedHandOptions hand =
        path_hand({{0.0, Pose::Zero()}, {2.0, Pose(0.0, -0.005 - push / 500.0, 0.0)}});
    hand.stiffness = 500.0;
    return hand;
}

ObservedToolOptions known(double rate) {
    ObservedToolOptions o;
    o.rate_hz = rate;
    o.observer = false;
    o.encoder = 1e-7;
    return o;
}

HandPlacement clutched(const ObservedTool& tool, bool on) {
    HandPlacement placement;
    placement.mapping = tool.session->settings().mapping;
    placement.clutched = on;
    return placement;
}

} // namespace

TEST_SUITE("placement") {
    TEST_CASE("a turn follows without a jump of its rate, and rests where it was wanted") {
        for (const double step : {1e-4, 1e-3, 4e-3}) {
            Turn turn(0.0);
            double rate = 0.0;
            for (int i = 0; i < static_cast<int>(3.0 / step); ++i) {
                turn.advance(12.0, step);
                CHECK(std::abs(turn.rate()) <= 10.0);
                CHECK(std::abs(turn.rate() - rate) < step * 100.0 + 1e-12);
                CHECK(turn.angle() < 12.0 + 1e-6);
                rate = turn.rate();
            }
            CHECK(turn.angle() == doctest::Approx(12.0).epsilon(1e-6));
        }
    }

    TEST_CASE("figures out of range are named, and ignored by the loop") {
        HandPlacement bad;
        bad.mapping.scale = 0.0;
        bad.turn = std::numeric_limits<double>::quiet_NaN();
        CHECK(validate(bad).size() == 2);
        CHECK(validate(HandPlacement{}).empty());
        Placement placement(HandPlacement{});
        placement.want(bad);
        placement.advance(0.0, 1e-3);
        CHECK(placement.share() == 1.0);
        CHECK(placement.turn().angle() == 0.0);
    }

    TEST_CASE("the clutch takes the force away and gives it back without a jump, and the tool stays") {
        for (const double rate : {500.0, 1000.0})
            for (const double push : {0.5, 2.0, 6.0}) {
                CAPTURE(rate);
                CAPTURE(push);
                ObservedToolOptions o = known(rate);
                o.hand = pressing(push);
                ObservedTool tool(o);
                const int second = static_cast<int>(rate);
                for (int i = 0; i < 6 * second; ++i)
                    tool.session->step();
                const double before = tool.session->report().force.y();
                REQUIRE(before > 0.3 * push);
                Watch watch(tool);
                tool.session->place(clutched(tool, true));
                watch.step(second);
                CHECK(tool.session->report().hand_share == 0.0);
                CHECK(tool.session->report().force.norm() == 0.0);
                const Vec2 parked = tool.session->report().grip.head<2>();
                // nothing holds the handle back now
                CHECK(tool.device->true_pose().y() == doctest::Approx(-0.005 - push / 500.0).epsilon(0.02));
                CHECK((tool.session->report().grip.head<2>() - parked).norm() < 1e-6);
                CHECK(tool.session->report().contact.y() > 0.9 * before);
                tool.session->place(clutched(tool, false));
                watch.step(2 * second);
                CHECK(tool.session->report().hand_share == 1.0);
                CHECK(watch.jump < 0.05);
                CHECK(tool.session->report().faults == Fault::none);
            }
    }

    TEST_CASE("clutching while the handle moves does not jump either") {
        for (const double rate : {500.0, 1000.0}) {
            ObservedToolOptions o = known(rate);
            o.distance = 0.05;
            o.hand = path_hand({{0.0, Pose::Zero()}, {1.0, Pose::Zero()}, {3.0, Pose(0.1, 0.0, 0.0)}});
            ObservedTool tool(o);
            const int second = static_cast<int>(rate);
            for (int i = 0; i < second * 3 / 2; ++i)
                tool.session->step();
            Watch watch(tool);
            for (const bool on : {true, false, true, false}) {
                tool.session->place(clutched(tool, on));
                watch.step(second / 3);
            }
            CHECK(watch.jump < 0.05);
        }
    }

    TEST_CASE("a tool lifted again and again by the clutch creates no energy") {
        ObservedToolOptions o = known(1000.0);
        o.distance = 0.02;
        o.gravity = Vec2(0.0, -9.81);
        o.tool_mass = 0.2;
        std::vector<HandTarget> path{{0.0, Pose::Zero()}};
        for (int lift = 0; lift < 5; ++lift) {
            path.push_back({1.0 + 3.0 * lift, Pose::Zero()});
            path.push_back({2.0 + 3.0 * lift, Pose(0.0, 0.02, 0.0)});
            path.push_back({2.5 + 3.0 * lift, Pose(0.0, 0.02, 0.0)});
            path.push_back({3.5 + 3.0 * lift, Pose::Zero()});
        }
        o.hand = path_hand(path);
        ObservedTool tool(o);
        const double start = tool.session->report().grip.y();
        double worst = 0.0;
        double base = 0.0;
        for (int i = 0; i < 15500; ++i) {
            if (i == 1500)
                base = tool.session->ledger().created();
            if (i > 1500)
                worst = std::max(worst, tool.session->ledger().created() - base);
            const double t = std::fmod(1e-3 * i - 2.0 + 3.0, 3.0);
            tool.session->place(clutched(tool, i > 2000 && t < 1.7));
            tool.session->step();
        }
        // four lifts of the tool's weight by 2 cm each are 0.16 J
        CHECK(tool.session->report().grip.y() - start > 0.06);
        CHECK(worst < 2e-3);
        CHECK(tool.session->report().faults == Fault::none);
    }

    TEST_CASE("a new scale and a new rotation come without a jump, and change what is felt by the square of "
              "the scale") {
        ObservedToolOptions o = known(1000.0);
        o.hand = pressing(1.0);
        ObservedTool tool(o);
        for (int i = 0; i < 4000; ++i)
            tool.session->step();
        const double before = tool.session->report().contact.y();
        CHECK(before == doctest::Approx(1.0).epsilon(0.15));
        const double stiffness = tool.session->gains().stiffness.x();
        Watch watch(tool);
        HandPlacement wanted = clutched(tool, false);
        wanted.mapping.scale = 2.0;
        tool.session->place(wanted);
        watch.step(4000);
        CHECK(watch.jump < 0.05);
        CHECK(tool.session->gains().stiffness.x() == doctest::Approx(stiffness / 4.0));
        // the tool stays where it was, but for what the hand's spring gives way
        const Pose held = tool.session->report().device;
        wanted.mapping.rotation = 0.5 * std::numbers::pi;
        tool.session->place(wanted);
        watch.step(2000);
        CHECK(watch.jump < 0.05);
        CHECK((tool.session->report().device - held).head<2>().norm() < 4e-3);
        CHECK((tool.session->handle_for(tool.session->report().device) - tool.device->true_pose()).norm() <
              1e-4);
        CHECK(tool.session->report().faults == Fault::none);
    }

    TEST_CASE("a turn of the scene turns the tool, torque and force without a jump") {
        ObservedToolOptions o = known(1000.0);
        o.distance = 0.05;
        o.hand = path_hand({{0.0, Pose::Zero()}, {100.0, Pose::Zero()}});
        ObservedTool tool(o);
        for (int i = 0; i < 1500; ++i)
            tool.session->step();
        HandPlacement wanted = clutched(tool, false);
        wanted.turn = 3.0 * std::numbers::pi;
        tool.session->place(wanted);
        double last = tool.session->report().force.z();
        double jump = 0.0;
        Watch watch(tool);
        for (int i = 0; i < 3000; ++i) {
            watch.step(1);
            jump = std::max(jump, std::abs(tool.session->report().force.z() - last));
            last = tool.session->report().force.z();
        }
        CHECK(tool.session->report().grip.z() == doctest::Approx(wanted.turn).epsilon(0.01));
        CHECK(watch.jump < 0.05);
        // 0.05 N at the end of a handle of 0.1 m
        CHECK(jump < 5e-3);
    }

    TEST_CASE(
        "an angle that the device wraps goes on growing: the tool turns on, and the torque does not jump") {
        // turns at 5 rad/s and tells its angle within half a turn, as a device without stops would
        class Knob final : public DevicePort {
          public:
            bool read(DeviceReading& reading) override {
                reading.pose = Pose(0.0, 0.0, std::remainder(5.0 * time_, 2.0 * std::numbers::pi));
                reading.sequence = ++sequence_;
                return true;
            }
            void write(const Wrench& /*force*/) override {}
            void advance(double dt) override { time_ += dt; }
            [[nodiscard]] Mat3 handle_mass(const Pose& /*pose*/) const override {
                return Vec3(0.3, 0.3, 3e-4).asDiagonal();
            }
            [[nodiscard]] int freedoms() const override { return 3; }

          private:
            double time_{0.0};
            std::uint64_t sequence_{0};
        };
        Knob knob;
        SafetyLimits limits;
        limits.max_torque = 1.0;
        limits.max_angular_speed = 50.0;
        OutputGate gate(limits);
        gate.set_homed(true);
        LinkageVector start = LinkageVector::Zero(3);
        Session session(SessionSettings{}, shared::box_tool(0.3), gate, knob, start);
        double largest = 0.0;
        for (int i = 0; i < 4000; ++i) {
            session.step();
            if (i > 500)
                largest = std::max(largest, std::abs(session.output().full_coupling.z()));
        }
        // three turns and more
        CHECK(session.report().grip.z() == doctest::Approx(20.0).epsilon(0.01));
        CHECK(largest < 0.05);
    }

    TEST_CASE("with two freedoms the scene turns the tool, and the hand feels no torque") {
        SimulatedPantographOptions d;
        d.geometry = haply_2diy_v3();
        d.hand = path_hand({{0.0, Pose::Zero()}, {100.0, Pose::Zero()}});
        SimulatedPantograph device(d);
        OutputGate gate{SafetyLimits{}};
        gate.set_homed(true);
        Session session(SessionSettings{}, shared::box_tool(0.3), gate, device, LinkageVector::Zero(3));
        for (int i = 0; i < 500; ++i)
            session.step();
        HandPlacement wanted;
        wanted.turn = -2.0;
        session.place(wanted);
        double jump = 0.0;
        Vec2 last = session.report().force.head<2>();
        for (int i = 0; i < 2000; ++i) {
            session.step();
            jump = std::max(jump, (session.report().force.head<2>() - last).norm());
            last = session.report().force.head<2>();
        }
        CHECK(session.report().grip.z() == doctest::Approx(-2.0).epsilon(0.01));
        CHECK(jump < 0.05);
        CHECK(session.report().faults == Fault::none);
    }

    TEST_CASE(
        "a push through a scaled mapping: the coupling bears what the device can give, no energy comes of "
        "it, and the hand feels its push") {
        for (const double scale : {0.3, 3.0}) {
            CAPTURE(scale);
            SimulatedPantographOptions d;
            d.encoder_model = EncoderModel::exact;
            d.measures_force = true;
            d.limit_motors = false;
            d.hand = pushing_hand(Wrench(0.0, -3.0, 0.0), 0.7);
            SimulatedPantograph device(d);
            SessionSettings s;
            s.mapping.scale = scale;
            s.reading_error.setZero();
            // the last half a step of a velocity from differences is 0.6 mJ on the way to the wall otherwise
            s.passivity_control = true;
            SafetyLimits limits;
            limits.max_force = 20.0;
            OutputGate gate(limits, device.kinematics());
            gate.set_homed(true);
            Session session(s, shared::box_tool(0.3), gate, device, Pose(0.0, 0.0125, 0.0));
            session.take(*shared::floor_of(1));
            for (int i = 0; i < 3000; ++i)
                session.step();
            const HapticReport& r = session.report();
            CHECK(r.energy_injected < 1e-4);
            CHECK(r.contacts == 1);
            CHECK(scale * r.force.y() == doctest::Approx(3.0).epsilon(0.01));
            CHECK(r.max_penetration == doctest::Approx(3.0 / scale / 15000.0).epsilon(0.01));
            // told as the device gives it
            CHECK(r.run.max_force >= 2.9);
            CHECK(r.run.max_force <= limits.max_force + 1e-9);
        }
    }

    TEST_CASE("clutch, mapping, turn, holding and grabbing in any order: finite, within the limits, and at "
              "peace in the end") {
        testing::Random random(77);
        for (int run = 0; run < 40; ++run) {
            CAPTURE(run);
            ObservedToolOptions o = known(run % 2 == 0 ? 1000.0 : 500.0);
            o.hand = pressing(random.uniform(0.0, 3.0));
            o.observer = run % 4 == 3;
            ObservedTool tool(o);
            Session& session = *tool.session;
            HandPlacement wanted;
            double largest = 0.0;
            for (int i = 0; i < 3000; ++i) {
                if (random.below(60) == 0) {
                    const int what = random.below(5);
                    const double drawn = random.uniform(-1.0, 1.0);
                    wanted.clutched = what == 0 ? !wanted.clutched : wanted.clutched;
                    wanted.mapping.scale = what == 1 ? std::exp(drawn) : wanted.mapping.scale;
                    wanted.mapping.rotation = what == 2 ? 3.0 * drawn : wanted.mapping.rotation;
                    wanted.turn = what == 3 ? 4.0 * drawn : wanted.turn;
                    session.place(wanted);
                    if (what == 4)
                        session.hold(drawn > -0.5);
                }
                if (random.below(200) == 0)
                    session.grab(Grip{0, Vec2(random.uniform(-0.01, 0.01), 0.0), random.below(2) == 0});
                session.step();
                const HapticReport& r = session.report();
                REQUIRE(r.grip.allFinite());
                REQUIRE(r.force.allFinite());
                REQUIRE(r.hand_share >= 0.0);
                REQUIRE(r.hand_share <= 1.0);
                largest =
                    std::max(largest, session.settings().mapping.wrench_to_device(r.force).head<2>().norm());
            }
            CHECK(largest <= 30.0 * 1.0001);
            wanted.clutched = false;
            session.place(wanted);
            // held by a point it would go on spinning
            session.grab(Grip{0, Vec2::Zero(), true});
            for (int i = 0; i < 4000; ++i)
                session.step();
            CHECK(session.report().hand_share == 1.0);
            CHECK(session.report().velocity.head<2>().norm() < 1e-2);
        }
    }
}
