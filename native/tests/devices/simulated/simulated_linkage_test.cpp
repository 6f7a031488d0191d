// The linkage model: joint friction, motors that hold torques, encoders at the joints, on geometries that
// nobody designed.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/pantograph/random_geometry.hpp"

using namespace haptics;
using haptics::testing::Random;
using haptics::testing::random_geometry;

namespace {

SimulatedPantographOptions linkage(const PantographGeometry& geometry) {
    SimulatedPantographOptions options;
    options.geometry = geometry;
    options.inertia_model = InertiaModel::linkage;
    options.viscous_friction = 0.0;
    options.rotation_viscous_friction = 0.0;
    options.encoder_model = EncoderModel::joint;
    return options;
}

double kinetic(const SimulatedPantograph& device) {
    const Twist& v = device.true_twist();
    return 0.5 * v.dot(device.handle_mass(device.true_pose()) * v);
}

JointVector angles_at(const SimulatedPantograph& device) {
    JointVector angles;
    device.kinematics().inverse(device.true_pose(), angles);
    return angles;
}

} // namespace

TEST_SUITE("simulated linkage") {
    TEST_CASE("joint friction takes the energy that rate and angle say") {
        Random random(501);
        for (int n = 0; n < 12; ++n) {
            const PantographGeometry g = random_geometry(random, 1 + n % 2);
            SimulatedPantograph device(linkage(g));
            const bool turns = g.bar_count == 2;
            REQUIRE(device.place(g.home, Twist(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                                               turns ? random.uniform(-2.0, 2.0) : 0.0)));
            double heat = 0.0;
            const double before = kinetic(device);
            for (int k = 0; k < 200; ++k) {
                const JointVector then = angles_at(device);
                device.advance(1.0e-4);
                const JointVector moved = (angles_at(device) - then).unaryExpr([](double a) {
                    return std::remainder(a, 6.283185307179586);
                });
                heat += g.motor.viscous_friction * moved.squaredNorm() / 1.0e-4 +
                        g.motor.coulomb_friction * moved.cwiseAbs().sum();
            }
            CHECK(before - kinetic(device) == doctest::Approx(heat).epsilon(0.02));
        }
    }

    TEST_CASE("joints stick below their friction and slip above it") {
        Random random(502);
        for (int n = 0; n < 12; ++n) {
            const PantographGeometry g = random_geometry(random, 1 + n % 2);
            SimulatedPantographOptions options = linkage(g);
            options.limit_motors = false;
            for (const double share : {0.95, 1.5}) {
                SimulatedPantograph device(options);
                REQUIRE(device.place(g.home));
                // friction torques that the wrench would have to overcome, all joints at their bound
                const PantographState state = device.kinematics().locate(g.home);
                JointVector bound = JointVector::Zero();
                for (int i = 0; i < device.kinematics().motors(); ++i)
                    bound[i] = g.motor.coulomb_friction * (random.below(2) == 0 ? 1.0 : -1.0);
                const Wrench push = share * (state.rates.transpose() * bound);
                device.write(push);
                for (int k = 0; k < 100; ++k)
                    device.advance(1.0e-3);
                const double moved = (angles_at(device) -
                                      [&] {
                                          JointVector home;
                                          device.kinematics().inverse(g.home, home);
                                          return home;
                                      }())
                                         .cwiseAbs()
                                         .maxCoeff();
                if (share < 1.0)
                    CHECK(moved < 1.0e-6);
                else if (device.freedoms() == 2)
                    CHECK(moved > 1.0e-3);
            }
        }
    }

    TEST_CASE("motors hold their torques between two commands, whatever the handle does") {
        Random random(503);
        for (int n = 0; n < 10; ++n) {
            PantographGeometry g = random_geometry(random, 1 + n % 2);
            g.motor.viscous_friction = 0.0;
            g.motor.coulomb_friction = 0.0;
            SimulatedPantographOptions options = linkage(g);
            options.limit_motors = false;
            SimulatedPantograph device(options);
            REQUIRE(device.place(g.home, Twist(0.1, -0.05, 0.0)));
            const PantographState state = device.kinematics().locate(g.home);
            const Wrench wrench(0.2, 0.1, 0.0);
            const TorqueSolution torque = joint_torques(device.kinematics(), state, wrench);
            REQUIRE(torque.scale == 1.0);
            const double before = kinetic(device);
            const JointVector start = angles_at(device);
            device.write(wrench);
            for (int k = 0; k < 40; ++k)
                device.advance(1.0e-3);
            const JointVector turned = (angles_at(device) - start).unaryExpr([](double a) {
                return std::remainder(a, 6.283185307179586);
            });
            // work of constant torques, not of a constant wrench
            CHECK(kinetic(device) - before == doctest::Approx(torque.torque.dot(turned)).epsilon(1.0e-4));
        }
    }

    TEST_CASE("readings are what the encoders of that very geometry can tell") {
        Random random(504);
        for (int n = 0; n < 20; ++n) {
            const PantographGeometry g = random_geometry(random, 1 + n % 2);
            SimulatedPantograph device(linkage(g));
            const Pose pose = haptics::testing::pose_near_home(device.kinematics(), random, 0.01);
            REQUIRE(device.place(pose));
            DeviceReading reading;
            REQUIRE(device.read(reading));
            REQUIRE(reading.has_angles);
            JointVector truth;
            device.kinematics().inverse(pose, truth);
            const double count = 6.283185307179586 / g.motor.counts_per_revolution;
            for (int i = 0; i < device.kinematics().motors(); ++i) {
                const double off = std::remainder(reading.angles[i] - truth[i], 6.283185307179586);
                CHECK(std::abs(off) <= 0.5001 * count);
                const double counts = device.kinematics().count_of_angle(i, reading.angles[i]);
                CHECK(std::abs(counts - std::round(counts)) < 1.0e-6);
            }
            CHECK((reading.pose - device.kinematics().forward(reading.angles).pose).norm() < 1.0e-12);
        }
    }

    TEST_CASE("motor limits are those of the geometry, gears included") {
        Random random(505);
        for (int n = 0; n < 12; ++n) {
            PantographGeometry g = random_geometry(random, 1 + n % 2);
            g.motor.viscous_friction = 0.0;
            g.motor.coulomb_friction = 0.0;
            SimulatedPantograph device(linkage(g));
            REQUIRE(device.place(g.home));
            const PantographState state = device.kinematics().locate(g.home);
            const Wrench wanted(400.0, -250.0, g.bar_count == 2 ? 5.0 : 0.0);
            const TorqueSolution can = joint_torques(device.kinematics(), state, wanted);
            REQUIRE(can.scale < 1.0);
            device.write(wanted);
            device.advance(2.0e-5);
            CHECK((device.motor_force() - can.scale * wanted).norm() < 1.0e-3 * wanted.norm());
        }
    }
}
