// Encoder check and compensation through the whole loop: simulated device, session, gate.

#include <haptics/core/control/session.hpp>
#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <memory>

#include "support/allocation_guard.hpp"

using namespace haptics;

namespace {

struct Loop {
    std::unique_ptr<SimulatedPantograph> device;
    std::unique_ptr<Session> session;

    Loop(const SimulatedPantographOptions& options, const DeviceCareSettings& care, double rate = 1000.0) {
        device = std::make_unique<SimulatedPantograph>(options);
        SessionSettings settings;
        settings.step = 1.0 / rate;
        settings.care = care;
        settings.reading_error = Vec3(4.0e-6, 4.0e-6, 1.0e-4);
        OutputGate gate(SafetyLimits{}, device->kinematics());
        gate.set_homed(true);
        session =
            std::make_unique<Session>(settings, shared::box_tool(0.1), gate, *device, Pose(0.0, 0.1, 0.0));
    }
    void run(int steps) {
        for (int k = 0; k < steps; ++k)
            session->step();
    }
};

SimulatedPantographOptions upright() {
    SimulatedPantographOptions options;
    options.geometry = ubc_twin_pantograph();
    options.geometry.motor.viscous_friction = 1.0e-3;
    options.geometry.motor.coulomb_friction = 2.0e-3;
    options.inertia_model = InertiaModel::linkage;
    options.encoder_model = EncoderModel::joint;
    options.viscous_friction = 0.0;
    options.rotation_viscous_friction = 0.0;
    options.gravity = Vec2(0.0, -9.81);
    return options;
}

} // namespace

TEST_SUITE("device care") {
    TEST_CASE("a slipped encoder takes the force off until the device is homed and armed again") {
        SimulatedPantographOptions options = upright();
        options.gravity.setZero();
        options.hand = pushing_hand(Wrench(0.5, 0.0, 0.0), 0.3);
        Loop loop(options, DeviceCareSettings{});
        loop.run(900);
        REQUIRE(loop.session->report().armed);
        REQUIRE(loop.session->report().faults == Fault::none);
        loop.device->slip_encoder(2, 40.0);
        loop.run(5);
        CHECK(has(loop.session->report().faults, Fault::home_the_device_again));
        CHECK_FALSE(loop.session->report().armed);
        // asking for force does not help
        loop.device->hand().set_force(Wrench::Zero());
        loop.session->arm();
        for (int k = 0; k < 300; ++k) {
            loop.run(1);
            REQUIRE(loop.session->report().force.isZero(0.0));
        }
        CHECK_FALSE(loop.session->report().armed);
        // homing does
        loop.device->home();
        loop.run(300);
        loop.session->arm();
        loop.run(300);
        CHECK(loop.session->report().armed);
        CHECK(loop.session->report().faults == Fault::none);
    }

    TEST_CASE("a device that stands upright falls, unless its weight is held") {
        const auto sag = [](const DeviceCareSettings& care) {
            SimulatedPantographOptions options = upright();
            options.hand = path_hand({{0.0, Pose::Zero()}, {9.0, Pose::Zero()}});
            Loop loop(options, care);
            loop.run(1500);
            REQUIRE(loop.session->report().armed);
            // the hand lets go
            loop.device->hand().set_grip(0.0, 0.0);
            loop.device->hand().set_rotation_grip(0.0, 0.0);
            const Pose before = loop.device->true_pose();
            loop.run(400);
            return (loop.device->true_pose() - before).head<2>().norm();
        };
        DeviceCareSettings held;
        held.compensation.gravity = Vec2(0.0, -9.81);
        const double free = sag(DeviceCareSettings{});
        const double kept = sag(held);
        MESSAGE("in 0.4 s it falls " << 1.0e3 * free << " mm, held " << 1.0e3 * kept << " mm");
        CHECK(free > 0.02);
        CHECK(kept < 1.0e-3);
    }

    TEST_CASE("a held device hangs still and moves as if without weight, friction halved, and nothing gains "
              "energy") {
        SimulatedPantographOptions options = upright();
        // a hand that holds it in place, then lets go
        options.hand.kind = HandKind::recorded_path;
        options.hand.stiffness = 500.0;
        options.hand.path = {{0.0, Pose(0, 0, 0)},         {1.5, Pose(0, 0, 0)},
                             {2.0, Pose(0.03, 0.02, 0.2)}, {2.5, Pose(-0.02, -0.03, -0.1)},
                             {3.0, Pose(0, 0, 0)},         {3.5, Pose(0, 0, 0)}};
        DeviceCareSettings care;
        care.compensation.gravity = Vec2(0.0, -9.81);
        care.compensation.friction_share = 0.5;
        care.compensation.inertia_share = 0.3;
        Loop loop(options, care);
        loop.run(1400);
        REQUIRE(loop.session->report().armed);
        const PantographKinematics& kinematics = loop.device->kinematics();
        const Wrench weight =
            gravity_wrench(kinematics, kinematics.locate(loop.device->true_pose()), options.gravity);
        CHECK(weight.norm() > 1.0);
        CHECK((loop.session->report().compensation + weight).norm() < 0.02 * weight.norm());
        CHECK(loop.device->hand_force().norm() < 0.1 * weight.norm());
        std::uint64_t taken = 0;
        double most = 0.0;
        {
            const haptics::testing::AllocationGuard guard;
            for (int k = 0; k < 2200; ++k) {
                loop.run(1);
                most = std::max(most, loop.device->hand_force().head<2>().norm());
            }
            taken = guard.allocations();
        }
        CHECK(taken == 0);
        CHECK(most < weight.norm());
        CHECK(loop.session->report().faults == Fault::none);
        // the compensation's own work is none of the controller's
        CHECK(loop.session->report().energy_injected < 2.0e-3);
    }
}
