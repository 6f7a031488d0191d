#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/allocation_guard.hpp"
#include "support/random.hpp"

using namespace haptics;

namespace {

// nothing but a mass: no friction, exact encoders, nobody holds it
SimulatedPantographOptions bare() {
    SimulatedPantographOptions options;
    options.viscous_friction = 0.0;
    options.rotation_viscous_friction = 0.0;
    options.encoder_model = EncoderModel::exact;
    return options;
}

double kinetic_of(const SimulatedPantograph& device) {
    const Twist& v = device.true_twist();
    return 0.5 * v.dot(device.handle_mass(device.true_pose()) * v);
}

} // namespace

TEST_SUITE("simulated pantograph") {
    TEST_CASE("a constant force accelerates the mass as Newton has it") {
        SimulatedPantograph device(bare());
        device.write(Wrench(0.3, -0.6, 3.0e-4));
        for (int k = 0; k < 200; ++k)
            device.advance(1.0e-3);
        // s = F t^2 / 2 m, with 0.3 kg and 3e-4 kg m^2
        CHECK(device.true_pose().x() == doctest::Approx(0.02).epsilon(1.0e-9));
        CHECK(device.true_pose().y() == doctest::Approx(-0.04).epsilon(1.0e-9));
        CHECK(device.true_pose().z() == doctest::Approx(0.02).epsilon(1.0e-9));
        CHECK(device.true_twist().x() == doctest::Approx(0.2).epsilon(1.0e-9));
    }

    TEST_CASE("held by a hand with spring and damper it swings as the closed form has it") {
        for (const double ratio : {0.0, 0.2, 1.0}) {
            SimulatedPantographOptions options = bare();
            options.hand = mouse_hand();
            options.hand.damping_ratio = ratio;
            SimulatedPantograph device(options);
            // started by a kick, towards a target that rests
            const double v0 = 0.2;
            REQUIRE(device.place(Pose::Zero(), Twist(v0, 0.0, 0.0)));
            const double w = std::sqrt(300.0 / 0.45);
            double worst = 0.0;
            for (int k = 1; k <= 400; ++k) {
                device.advance(1.0e-3);
                const double t = 1.0e-3 * k;
                const double wd = w * std::sqrt(1.0 - ratio * ratio);
                const double swing = ratio < 1.0 ? std::sin(wd * t) / wd : t;
                worst =
                    std::max(worst, std::abs(device.true_pose().x() - v0 * std::exp(-ratio * w * t) * swing));
            }
            CHECK(worst < 1.0e-7);
        }
    }

    TEST_CASE("Coulomb friction sticks below its limit and slides above it") {
        SimulatedPantographOptions options = bare();
        options.coulomb_friction = 0.5;
        SimulatedPantograph device(options);
        device.write(Wrench(0.3, 0.39, 0.0)); // 0.492 N
        for (int k = 0; k < 500; ++k)
            device.advance(1.0e-3);
        CHECK(device.true_pose().norm() < 1.0e-8);
        device.write(Wrench(0.8, 0.0, 0.0));
        for (int k = 0; k < 100; ++k)
            device.advance(1.0e-3);
        CHECK(device.true_twist().x() == doctest::Approx(0.3 / 0.3 * 0.1).epsilon(1.0e-6));
        // let go: it stops after v^2 / 2a and stays
        device.write(Wrench::Zero());
        const double from = device.true_pose().x();
        for (int k = 0; k < 200; ++k)
            device.advance(1.0e-3);
        CHECK(device.true_twist().norm() == 0.0);
        CHECK(device.true_pose().x() - from ==
              doctest::Approx(0.5 * 0.1 * 0.1 / (0.5 / 0.3)).epsilon(1.0e-3));
    }

    TEST_CASE("the linkage with its links and rotors keeps its energy while coasting") {
        for (const PantographGeometry& geometry : {ubc_twin_pantograph(), haply_2diy_v3()}) {
            SimulatedPantographOptions options = bare();
            options.geometry = geometry;
            options.inertia_model = InertiaModel::linkage;
            SimulatedPantograph device(options);
            const Twist twist(0.12, -0.08, geometry.bar_count == 2 ? 1.5 : 0.0);
            REQUIRE(device.place(Pose(-0.01, 0.01, 0.0), twist));
            const double before = kinetic_of(device);
            double worst = 0.0;
            Mat3 first = device.handle_mass(device.true_pose());
            for (int k = 0; k < 250; ++k) {
                device.advance(1.0e-3);
                worst = std::max(worst, std::abs(kinetic_of(device) / before - 1.0));
            }
            CHECK(worst < 1.0e-6);
            // and the inertia really changed on the way
            CHECK((device.handle_mass(device.true_pose()) - first).norm() > 0.005 * first.norm());
        }
    }

    TEST_CASE("a device that stands upright swings with kinetic plus potential energy constant") {
        SimulatedPantographOptions options = bare();
        options.inertia_model = InertiaModel::linkage;
        options.gravity = Vec2(0.0, -1.0);
        SimulatedPantograph device(options);
        const auto total = [&] {
            const PantographState state = device.kinematics().locate(device.true_pose());
            return kinetic_of(device) +
                   gravity_potential(device.kinematics(), device.true_pose(), state, options.gravity);
        };
        const double before = total();
        for (int k = 0; k < 250; ++k)
            device.advance(1.0e-3);
        CHECK(device.true_pose().y() < -0.01);
        CHECK(std::abs(total() - before) < 1.0e-6 * kinetic_of(device));
    }

    TEST_CASE("rounding of the handle encoder is even and has the variance of a uniform error") {
        SimulatedPantographOptions options = bare();
        options.encoder_model = EncoderModel::handle;
        SimulatedPantograph device(options);
        testing::Random random(41);
        DeviceReading reading;
        Vec3 sum = Vec3::Zero();
        Vec3 square = Vec3::Zero();
        double largest = 0.0;
        const int count = 20000;
        for (int k = 0; k < count; ++k) {
            const Pose pose(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                            random.uniform(-0.5, 0.5));
            REQUIRE(device.place(pose));
            device.read(reading);
            const Vec3 error = (reading.pose - pose).cwiseQuotient(options.encoder_resolution);
            sum += error;
            square += error.cwiseAbs2();
            largest = std::max(largest, error.cwiseAbs().maxCoeff());
        }
        CHECK(largest <= 0.5 + 1.0e-6);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(std::abs(sum[axis] / count) < 0.01);
            CHECK(square[axis] / count == doctest::Approx(1.0 / 12.0).epsilon(0.03));
        }
    }

    TEST_CASE("joint encoders round to whole counts, and the pose is as fine as the geometry makes it") {
        SimulatedPantographOptions options = bare();
        options.encoder_model = EncoderModel::joint;
        options.geometry = haply_2diy_v3();
        SimulatedPantograph device(options);
        testing::Random random(42);
        DeviceReading reading;
        double largest = 0.0;
        for (int k = 0; k < 5000; ++k) {
            REQUIRE(device.place(Pose(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0)));
            device.read(reading);
            JointVector angles;
            device.kinematics().inverse(reading.pose, angles);
            for (int i = 0; i < 2; ++i) {
                const double count = device.kinematics().count_of_angle(i, angles[i]);
                REQUIRE(std::abs(count - std::round(count)) < 1.0e-6);
            }
            largest = std::max(largest, (reading.pose - device.true_pose()).norm());
        }
        // half a count on each joint is 0.64 mrad; links of 70 mm
        CHECK(largest > 0.02e-3);
        CHECK(largest < 0.15e-3);
    }

    TEST_CASE("a delay of n steps is n steps, and a delay in seconds is exact to half a sub-step") {
        for (const int steps : {0, 1, 5}) {
            SimulatedPantographOptions options = bare();
            options.command_delay_steps = steps;
            SimulatedPantograph device(options);
            for (int k = 0; k < 10; ++k) {
                device.write(Wrench(1.0, 0.0, 0.0));
                device.advance(1.0e-3);
                CHECK((device.motor_force().x() > 0.0) == (k >= steps));
            }
        }
        SimulatedPantographOptions options = bare();
        options.command_delay = 3.4e-3;
        SimulatedPantograph device(options);
        for (int k = 0; k < 10; ++k) {
            device.write(Wrench(1.0, 0.0, 0.0));
            device.advance(1.0e-3);
        }
        // 10 ms less 3.4 ms of 1 N on 0.3 kg
        CHECK(device.true_twist().x() == doctest::Approx(6.6e-3 / 0.3).epsilon(1.0e-9));
    }

    TEST_CASE("late readings are old ones") {
        SimulatedPantographOptions options = bare();
        options.reading_delay_steps = 3;
        SimulatedPantograph device(options);
        REQUIRE(device.place(Pose::Zero(), Twist(0.1, 0.0, 0.0)));
        DeviceReading reading;
        for (int k = 0; k < 50; ++k) {
            device.read(reading);
            CHECK(reading.pose.x() == doctest::Approx(1.0e-4 * std::max(0, k - 3)));
            CHECK(reading.sequence == static_cast<std::uint64_t>(k) + 1);
            device.advance(1.0e-3);
        }
    }

    TEST_CASE("motors scale a command that they cannot give") {
        SimulatedPantographOptions options = bare();
        options.geometry = haply_2diy_v3();
        SimulatedPantograph device(options);
        device.write(Wrench(6.0, 8.0, 0.0));
        device.advance(1.0e-3);
        CHECK(device.motor_force().norm() < 4.0);
        CHECK(device.motor_force().y() / device.motor_force().x() == doctest::Approx(8.0 / 6.0));
    }

    TEST_CASE("the handle stays in the workspace whatever pushes it, and finds back") {
        for (const PantographGeometry& geometry :
             {pantograph_mk2(), haply_2diy_v2(), haply_2diy_v3(), ubc_twin_pantograph()}) {
            SimulatedPantographOptions options;
            options.geometry = geometry;
            options.limit_motors = false;
            SimulatedPantograph device(options);
            testing::Random random(43);
            Wrench push = Wrench::Zero();
            DeviceReading reading;
            int outside = 0;
            for (int k = 0; k < 6000; ++k) {
                if (k % 300 == 0)
                    push =
                        Wrench(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-0.5, 0.5));
                device.write(push);
                device.advance(1.0e-3);
                device.read(reading);
                outside +=
                    device.kinematics().workspace(device.true_pose()).inside && reading.pose.allFinite() ? 0
                                                                                                         : 1;
            }
            CHECK(outside == 0);
            // a hand's pull brings it home
            for (int k = 0; k < 3000; ++k) {
                const Pose& at = device.true_pose();
                device.write(Wrench(-100.0 * at.x() - 10.0 * device.true_twist().x(),
                                    -100.0 * at.y() - 10.0 * device.true_twist().y(),
                                    -0.1 * at.z() - 0.01 * device.true_twist().z()));
                device.advance(1.0e-3);
            }

            CHECK(device.true_pose().norm() < 1.0e-3);
        }
    }

    TEST_CASE("the measured force is what accelerates the handle") {
        SimulatedPantographOptions options = bare();
        options.measures_force = true;
        options.hand = pushing_hand(Wrench(0.9, 0.0, 0.0));
        options.hand.mass = 0.15;
        SimulatedPantograph device(options);
        for (int k = 0; k < 50; ++k)
            device.advance(1.0e-3);
        DeviceReading reading;
        device.read(reading);
        REQUIRE(reading.has_hand_force);
        // 0.9 N move 0.45 kg; two thirds of it reach the handle's 0.3 kg
        CHECK(reading.hand_force.x() == doctest::Approx(0.6).epsilon(1.0e-9));
        CHECK_FALSE(reading.has_velocity);
    }

    TEST_CASE("same options and calls give the same bits, another seed does not; nothing allocates") {
        const auto run = [](std::uint64_t seed) {
            SimulatedPantographOptions options;
            options.encoder_model = EncoderModel::handle;
            options.noise = Vec3(1.0e-5, 1.0e-5, 1.0e-4);
            options.seed = seed;
            options.coulomb_friction = 0.05;
            options.command_delay = 1.0e-3;
            options.hand = mouse_hand();
            SimulatedPantograph device(options);
            DeviceReading reading;
            Pose sum = Pose::Zero();
            const testing::AllocationGuard guard;
            for (int k = 0; k < 500; ++k) {
                if (k % 16 == 0)
                    device.set_target({device.time(), Pose(0.02 * std::sin(0.01 * k), 0.0, 0.1)});
                device.read(reading);
                sum += reading.pose;
                device.write(-5.0 * reading.pose);
                device.advance(1.0e-3);
            }
            const auto allocations = guard.allocations();
            CHECK(allocations == 0);
            return sum;
        };
        CHECK(run(7) == run(7));
        CHECK(run(7) != run(8));
    }

    TEST_CASE("unusable options are named, and refused") {
        SimulatedPantographOptions options;
        options.mass = 0.0;
        options.hand.stiffness = std::numeric_limits<double>::quiet_NaN();
        const std::vector<FigureError> errors = validate(options);
        REQUIRE(errors.size() == 2);
        CHECK(errors[0].field == "mass");
        CHECK(errors[1].field == "hand.stiffness");
        CHECK_THROWS_AS(SimulatedPantograph{options}, std::invalid_argument);
    }

    TEST_CASE("broken commands and times do nothing") {
        SimulatedPantograph device(bare());
        const double nan = std::numeric_limits<double>::quiet_NaN();
        device.write(Wrench(nan, 0.0, 0.0));
        device.advance(nan);
        device.advance(-1.0);
        device.advance(1.0e-3);
        device.set_target({nan, Pose::Zero()});
        device.hand().set_force(Wrench(nan, nan, nan));
        CHECK(device.true_pose().norm() == 0.0);
        CHECK(device.time() == doctest::Approx(1.0e-3));
    }
}
