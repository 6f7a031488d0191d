#include <haptics/core/pantograph/presets.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/core/safety/output_gate.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "support/allocation_guard.hpp"
#include "support/random.hpp"

using namespace haptics;
using haptics::testing::Random;

namespace {

constexpr double k_dt = 1.0e-3;

// a gate that is homed, has seen rest, is armed and past its ramp
template <typename... Arguments>
OutputGate running(const Arguments&... arguments) {
    OutputGate gate(arguments...);
    gate.set_homed(true);
    for (int i = 0; i < 100; ++i)
        gate.apply(Wrench::Zero(), Pose::Zero(), Twist::Zero(), k_dt);
    REQUIRE(gate.arm(false) == ArmResult::armed);
    for (int i = 0; i < 600; ++i)
        gate.apply(Wrench::Zero(), Pose::Zero(), Twist::Zero(), k_dt);
    return gate;
}

long inputs_to_try() {
    const char* wanted = std::getenv("HAPTICS_GATE_INPUTS");
    const long count = wanted != nullptr ? std::strtol(wanted, nullptr, 10) : 0;
    return count > 0 ? count : 2'000'000;
}

} // namespace

TEST_SUITE("output gate") {
    TEST_CASE("no force before homing, before arming, while moving or touching") {
        OutputGate gate{SafetyLimits{}};
        const Wrench push(1.0, 0.0, 0.0);
        CHECK(gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt).applied.norm() == 0.0);
        CHECK(gate.arm(false) == ArmResult::home_the_device_first);
        gate.set_homed(true);
        CHECK(gate.arm(false) == ArmResult::hold_the_handle_still);
        for (int i = 0; i < 100; ++i)
            CHECK(gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt).applied.norm() == 0.0);
        CHECK(gate.arm(false) == ArmResult::leave_contact); // 1 N is not free space
        gate.apply(Wrench::Zero(), Pose::Zero(), Twist::Zero(), k_dt);
        CHECK(gate.arm(true) == ArmResult::leave_contact);
        gate.apply(Wrench::Zero(), Pose::Zero(), Twist(0.5, 0.0, 0.0), k_dt);
        CHECK(gate.arm(false) == ArmResult::hold_the_handle_still);
        for (int i = 0; i < 100; ++i)
            gate.apply(Wrench::Zero(), Pose::Zero(), Twist::Zero(), k_dt);
        CHECK(gate.arm(false) == ArmResult::armed);
        CHECK(gate.arm(false) == ArmResult::already_armed);
        gate.set_homed(false);
        CHECK(gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt).applied.norm() == 0.0);
    }

    TEST_CASE("forces ramp up after arming and fade on pause without a fault") {
        SafetyLimits limits;
        OutputGate gate(limits);
        gate.set_homed(true);
        for (int i = 0; i < 100; ++i)
            gate.apply(Wrench::Zero(), Pose::Zero(), Twist::Zero(), k_dt);
        REQUIRE(gate.arm(false) == ArmResult::armed);
        const Wrench push(0.0, 2.0, 0.0);
        double last = 0.0;
        for (int i = 1; i <= 500; ++i) {
            const double force = gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt).applied.y();
            REQUIRE(force == doctest::Approx(2.0 * i / 500.0));
            REQUIRE(force - last < 0.0041);
            last = force;
        }
        gate.set_paused(true);
        for (int i = 0; i < 50; ++i)
            gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt);
        CHECK(gate.applied().norm() < 1.0e-12);
        gate.set_paused(false);
        for (int i = 0; i < 51; ++i)
            gate.apply(push, Pose::Zero(), Twist::Zero(), k_dt);
        CHECK(gate.applied().y() == doctest::Approx(2.0));
        CHECK(gate.faults() == Fault::none);
    }

    TEST_CASE("clamping scales the whole wrench") {
        OutputGate gate = running(SafetyLimits{});
        const Wrench command(30.0, 40.0, 0.1);
        GateOutput out;
        for (int i = 0; i < 50; ++i)
            out = gate.apply(command, Pose::Zero(), Twist::Zero(), k_dt);
        CHECK(has(out.flags, GateFlag::force_clamped));
        CHECK((out.applied - command * (8.0 / 50.0)).norm() < 1.0e-12);
        for (int i = 0; i < 50; ++i)
            out = gate.apply(Wrench(1.0, 0.0, 2.0), Pose::Zero(), Twist::Zero(), k_dt);
        CHECK((out.applied - Wrench(0.1, 0.0, 0.2)).norm() < 1.0e-12);
    }

    TEST_CASE("a collision impulse passes in one step, at every restitution up to 1") {
        SafetyLimits limits;
        limits.max_force = 100.0;
        for (const double restitution : {0.0, 0.5, 1.0}) {
            for (const double speed : {0.02, 0.1, 0.5}) {
                OutputGate gate = running(limits);
                const Twist into_wall(-0.6 * speed, -0.8 * speed, 0.0);
                gate.apply(Wrench::Zero(), Pose::Zero(), into_wall, k_dt);
                // 0.1 kg against a wall below: the impulse over one step
                const double force = (1.0 + restitution) * 0.1 * 0.8 * speed / k_dt;
                const GateOutput out = gate.apply(Wrench(0.0, force, 0.0), Pose::Zero(), into_wall, k_dt);
                CHECK(out.applied.y() == doctest::Approx(std::min(force, 100.0)));
                CHECK_FALSE(has(out.flags, GateFlag::slew_limited));
            }
        }
    }

    TEST_CASE("a jump that drives the motion, or starts one from rest, is slowed to the slew limit") {
        const SafetyLimits limits;
        for (const double speed : {0.0, 0.3}) {
            OutputGate gate = running(limits);
            const GateOutput out =
                gate.apply(Wrench(8.0, 0.0, 0.0), Pose::Zero(), Twist(speed, 0.0, 0.0), k_dt);
            CHECK(out.applied.x() == doctest::Approx(limits.force_slew * k_dt));
            CHECK(has(out.flags, GateFlag::slew_limited));
        }
    }

    TEST_CASE(
        "no change that the slew limit lets pass gives the reference mass more energy than a slewed one") {
        SafetyLimits limits;
        limits.max_force = 50.0;
        limits.max_torque = 2.0;
        limits.max_energy = 100.0;
        OutputGate gate = running(limits);
        Random random(31);
        int limited = 0;
        for (int trial = 0; trial < 200'000; ++trial) {
            const Wrench before = gate.applied();
            const Wrench command(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-1, 1));
            const Twist twist(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-5, 5));
            const Wrench change = gate.apply(command, Pose::Zero(), twist, k_dt).applied - before;
            const double kinetic = change.head<2>().squaredNorm() / limits.reference_mass +
                                   change.z() * change.z() / limits.reference_inertia;
            const double gained = k_dt * change.dot(twist) + 0.5 * k_dt * k_dt * kinetic;
            const bool slow = change.head<2>().norm() <= limits.force_slew * k_dt * 1.000001 &&
                              std::abs(change.z()) <= limits.torque_slew * k_dt * 1.000001;
            REQUIRE((slow || gained <= 1.0e-9));
            limited += slow ? 1 : 0;
        }
        CHECK(limited > 1000);
        CHECK(gate.faults() == Fault::none);
    }

    TEST_CASE("each bad input latches its own fault, kills the force at once and needs a re-arm") {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const auto check = [](Fault expected, auto&& provoke) {
            OutputGate gate = running(SafetyLimits{}, PantographKinematics(ubc_twin_pantograph()));
            for (int i = 0; i < 50; ++i)
                gate.apply(Wrench(2.0, 0.0, 0.0), Pose::Zero(), Twist::Zero(), k_dt);
            REQUIRE(gate.applied().x() == doctest::Approx(2.0));
            provoke(gate);
            CHECK(gate.faults() == expected);
            CHECK(gate.applied().norm() == 0.0);
            // good inputs do not bring the force back
            for (int i = 0; i < 200; ++i)
                REQUIRE(gate.apply(Wrench(0.1, 0.0, 0.0), Pose::Zero(), Twist::Zero(), k_dt).applied.norm() ==
                        0.0);
            CHECK(gate.faults() == expected);
            CHECK(gate.arm(false) == ArmResult::armed);
            CHECK(gate.faults() == Fault::none);
        };
        const Wrench small(1.0, 0.0, 0.0);
        check(Fault::fix_the_controller, [&](OutputGate& gate) {
            gate.apply(Wrench(nan, 0.0, 0.0), Pose::Zero(), Twist::Zero(), k_dt);
        });
        check(Fault::check_the_encoders,
              [&](OutputGate& gate) { gate.apply(small, Pose(0.0, nan, 0.0), Twist::Zero(), k_dt); });
        check(Fault::restart_the_loop,
              [&](OutputGate& gate) { gate.apply(small, Pose::Zero(), Twist::Zero(), 0.0); });
        check(Fault::move_slower_or_soften_the_coupling, [&](OutputGate& gate) {
            for (int i = 0; i < 4; ++i)
                gate.apply(small, Pose::Zero(), Twist(3.0, 0.0, 0.0), k_dt);
            CHECK(gate.faults() == Fault::none); // patience
            for (int i = 0; i < 4; ++i)
                gate.apply(small, Pose::Zero(), Twist(3.0, 0.0, 0.0), k_dt);
        });
        check(Fault::bring_the_handle_back_into_the_workspace,
              [&](OutputGate& gate) { gate.apply(small, Pose(0.5, 0.0, 0.0), Twist::Zero(), k_dt); });
        check(Fault::release_the_stop, [](OutputGate& gate) { gate.raise(Fault::release_the_stop); });
        check(Fault::soften_the_coupling_or_add_damping, [](OutputGate& gate) {
            // 8 N that pushes along at 1 m/s gives 3 J in under half a second
            for (int i = 0; i < 600; ++i)
                gate.apply(Wrench(8.0 * (i % 100 < 50 ? 1.0 : -1.0), 0.0, 0.0),
                           Pose(1.0e-3 * (i % 100 < 50 ? i % 50 : 50 - i % 50), 0.0, 0.0), Twist::Zero(),
                           k_dt);
        });
    }

    TEST_CASE("forces fade towards the edge of reach and are gone at it") {
        const PantographKinematics kinematics(haply_2diy_v2());
        OutputGate gate = running(SafetyLimits{}, kinematics);
        double last = 10.0;
        for (double y = 0.053; y < 0.062; y += 0.0005) {
            GateOutput out;
            for (int i = 0; i < 20; ++i)
                out = gate.apply(Wrench(0.5, 0.0, 0.0), Pose(0.0, y, 0.0), Twist::Zero(), k_dt);
            CHECK(out.applied.x() <= last + 1.0e-12);
            last = out.applied.x();
            if (y < 0.0545)
                CHECK(last == doctest::Approx(0.5));
            if (y > 0.06)
                CHECK(last == 0.0);
        }
    }

    TEST_CASE("adversarial inputs: never above a limit, never NaN, never a force without arming") {
        const SafetyLimits limits;
        const PantographKinematics kinematics(ubc_twin_pantograph());
        OutputGate gate = running(limits, kinematics);
        Random random(32);
        const double infinity = std::numeric_limits<double>::infinity();
        const double odd[] = {0.0,
                              -0.0,
                              1.0e-320,
                              1.0e-12,
                              1.0e12,
                              1.0e300,
                              -1.0e308,
                              8.0,
                              -8.0,
                              0.2,
                              infinity,
                              -infinity,
                              std::numeric_limits<double>::quiet_NaN()};
        const auto value = [&](double size, int odds) {
            return random.below(odds) == 0 ? odd[random.below(13)] : random.uniform(-size, size);
        };
        long with_force = 0;
        long bad = 0;
        const long count = inputs_to_try();
        Pose pose = Pose::Zero();
        const haptics::testing::AllocationGuard guard;
        for (long trial = 0; trial < count; ++trial) {
            // mostly plausible with rare poison, so that the gate is armed most of the time
            const int odds = 4000;
            const double big = random.below(3) == 0 ? 1.0e3 : 10.0;
            const Wrench command(value(big, odds), value(big, odds), value(0.1 * big, odds));
            if (random.below(200) == 0)
                pose = Pose(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-1.4, 1.4));
            Pose seen = pose + Pose(value(1.0e-5, odds), value(1.0e-5, odds), value(1.0e-4, odds));
            const Twist twist(value(1.8, odds), value(1.8, odds), value(30.0, odds));
            const double dt =
                random.below(odds) == 0 ? odd[random.below(13)] : random.uniform(1.0e-4, 4.0e-3);
            const GateOutput out = gate.apply(command, seen, twist, dt);
            bool fine = out.applied.allFinite() &&
                        out.applied.head<2>().norm() <= limits.max_force * (1.0 + 1.0e-12) &&
                        std::abs(out.applied.z()) <= limits.max_torque * (1.0 + 1.0e-12);
            if (out.applied.squaredNorm() > 0.0) {
                fine = fine && gate.armed() && out.faults == Fault::none;
                // what the motors really have to give for it
                const TorqueSolution torque = joint_torques(kinematics, kinematics.locate(seen), out.applied);
                fine = fine && torque.scale > 1.0 - 1.0e-9;
                ++with_force;
            }
            bad += fine ? 0 : 1;
            if (!gate.armed()) {
                pose.setZero();
                for (int i = 0; i < 60; ++i)
                    gate.apply(Wrench::Zero(), pose, Twist::Zero(), k_dt);
                bad += gate.arm(false) == ArmResult::armed ? 0 : 1;
            }
        }
        CHECK(guard.allocations() == 0);
        CHECK(bad == 0);
        CHECK(with_force > count / 3);
    }

    TEST_CASE("limits out of range are named") {
        SafetyLimits limits;
        CHECK(validate(limits).empty());
        limits.max_force = -1.0;
        limits.ramp_time = std::numeric_limits<double>::quiet_NaN();
        const auto errors = validate(limits);
        REQUIRE(errors.size() == 2);
        CHECK(errors[0].field == "max_force");
        CHECK(errors[1].problem == FigureProblem::not_finite);
    }

    TEST_CASE("every fault bit has a sentence") {
        for (int bit = 0; bit < k_fault_count; ++bit)
            CHECK(std::string(describe_fault(bit)).size() > 20);
        CHECK(std::string(describe_fault(k_fault_count)).empty());
        CHECK(std::string(describe_fault(-1)).empty());
    }

    TEST_CASE("every refusal to arm says what to do, and no success does") {
        for (const ArmResult refused : {ArmResult::home_the_device_first, ArmResult::hold_the_handle_still,
                                        ArmResult::leave_contact, ArmResult::remove_the_cause_first})
            CHECK(std::string(describe_arming(refused)).size() > 20);
        CHECK(std::string(describe_arming(ArmResult::armed)).empty());
        CHECK(std::string(describe_arming(ArmResult::already_armed)).empty());
    }
}
