#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "core/pantograph/poses.hpp"

using namespace haptics;
using haptics::testing::all_presets;
using haptics::testing::Random;
using haptics::testing::random_pose;

namespace {

Twist random_twist(Random& random, int freedoms) {
    return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
            freedoms == 3 ? random.uniform(-8.0, 8.0) : 0.0};
}

// kinetic energy from moving every part a little, with no Jacobian
double kinetic_energy(const PantographKinematics& kinematics, const Pose& pose, const Twist& twist) {
    const double h = 1.0e-5;
    const PantographGeometry& g = kinematics.geometry();
    const PantographState before = kinematics.locate(pose - h * twist);
    const PantographState after = kinematics.locate(pose + h * twist);
    const auto turned = [h](const Vec2& a, const Vec2& b) {
        return std::atan2(cross(a, b), a.dot(b)) / (2.0 * h);
    };
    double energy =
        0.5 * g.handle_mass * twist.head<2>().squaredNorm() + 0.5 * g.handle_inertia * twist.z() * twist.z();
    for (std::size_t i = 0; i < static_cast<std::size_t>(kinematics.motors()); ++i) {
        const FiveBarGeometry& bar = g.bar[i / 2];
        const LegState& a = before.leg[i];
        const LegState& b = after.leg[i];
        const double joint = turned(a.proximal, b.proximal);
        const double distal = turned(a.distal, b.distal);
        const Vec2 p = bar.proximal_center * (b.proximal - a.proximal) / (2.0 * h);
        const Vec2 d = (b.base + b.proximal + bar.distal_center * b.distal - a.base - a.proximal -
                        bar.distal_center * a.distal) /
                       (2.0 * h);
        const double rotor = g.motor.rotor_inertia * g.gear_ratio[i] * g.gear_ratio[i];
        energy += 0.5 * bar.proximal_mass * p.squaredNorm() + 0.5 * bar.distal_mass * d.squaredNorm() +
                  0.5 * (bar.proximal_inertia + rotor) * joint * joint +
                  0.5 * bar.distal_inertia * distal * distal;
    }
    return energy;
}

} // namespace

TEST_SUITE("pantograph inertia") {
    TEST_CASE("the mass matrix gives the kinetic energy of the moving parts") {
        Random random(21);
        for (PantographGeometry geometry : all_presets()) {
            // no center in the middle, a gear: nothing may cancel by symmetry
            geometry.bar[0].proximal_center = 0.3;
            geometry.bar[1].distal_center = 0.7;
            geometry.gear_ratio = {2.0, 1.0, 3.0, 1.5};
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 500; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                const Twist twist = random_twist(random, kinematics.freedoms());
                const Mat3 mass = handle_mass_matrix(kinematics, kinematics.locate(pose));
                const double expected = kinetic_energy(kinematics, pose, twist);
                REQUIRE(0.5 * twist.dot(mass * twist) == doctest::Approx(expected).epsilon(1.0e-5));
                REQUIRE((mass - mass.transpose()).norm() < 1.0e-12);
                REQUIRE(mass.llt().info() == Eigen::Success);
            }
        }
    }

    TEST_CASE("velocity terms agree with Lagrange's equations by differences") {
        Random random(22);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            const auto mass = [&](const Pose& pose) {
                return handle_mass_matrix(kinematics, kinematics.locate(pose));
            };
            for (int trial = 0; trial < 300; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                const Twist twist = random_twist(random, kinematics.freedoms());
                const double h = 1.0e-6;
                // d/dt (M v) at constant v, less the slope of the kinetic energy
                Wrench expected = (mass(pose + h * twist) - mass(pose - h * twist)) * twist / (2.0 * h);
                for (int axis = 0; axis < kinematics.freedoms(); ++axis) {
                    Pose ahead = pose;
                    Pose behind = pose;
                    ahead[axis] += h;
                    behind[axis] -= h;
                    expected[axis] -= 0.5 * twist.dot((mass(ahead) - mass(behind)) * twist) / (2.0 * h);
                }
                const Wrench found = velocity_wrench(kinematics, kinematics.locate(pose), twist);
                REQUIRE((found - expected).norm() < 1.0e-5 * std::max(1.0, expected.norm()));
            }
        }
    }

    TEST_CASE("the gravity wrench is the slope of the potential, and the torques hold it") {
        Random random(23);
        const Vec2 gravity(1.5, -9.81);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 300; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                const PantographState state = kinematics.locate(pose);
                const Wrench wrench = gravity_wrench(kinematics, state, gravity);
                for (int axis = 0; axis < kinematics.freedoms(); ++axis) {
                    const double h = 1.0e-5;
                    Pose ahead = pose;
                    Pose behind = pose;
                    ahead[axis] += h;
                    behind[axis] -= h;
                    const double slope =
                        (gravity_potential(kinematics, ahead, kinematics.locate(ahead), gravity) -
                         gravity_potential(kinematics, behind, kinematics.locate(behind), gravity)) /
                        (2.0 * h);
                    REQUIRE(std::abs(wrench[axis] + slope) < 1.0e-5);
                }
                if (joint_torques(kinematics, state, -wrench).scale < 1.0)
                    continue;
                const Wrench held = state.rates.transpose() * gravity_torque(kinematics, state, gravity);
                REQUIRE((held + wrench).head(kinematics.freedoms()).norm() < 1.0e-9);
            }
        }
    }

    TEST_CASE("joint friction never adds power") {
        Random random(24);
        PantographGeometry geometry = ubc_twin_pantograph();
        geometry.motor.viscous_friction = 0.002;
        geometry.motor.coulomb_friction = 0.01;
        const PantographKinematics kinematics(geometry);
        for (int trial = 0; trial < 1000; ++trial) {
            const PantographState state = kinematics.locate(random_pose(kinematics, random));
            const Twist twist = random_twist(random, 3);
            REQUIRE(joint_friction_wrench(kinematics, state, twist).dot(twist) < 0.0);
        }
    }
}
