#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/pantograph/poses.hpp"

using namespace haptics;
using haptics::testing::all_presets;
using haptics::testing::Random;
using haptics::testing::random_pose;

namespace {

Wrench random_wrench(Random& random, double force, double torque) {
    return {random.uniform(-force, force), random.uniform(-force, force), random.uniform(-torque, torque)};
}

// null vector of rates^T by an orthogonal decomposition: not how the code under test finds it
Eigen::Vector4d null_vector(const JointJacobian& rates) {
    return shared::kernel(rates.transpose()).col(0);
}

} // namespace

TEST_SUITE("torque map") {
    TEST_CASE("the torques give the wanted wrench, scaled as said, within limits") {
        Random random(11);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            int scaled = 0;
            for (int trial = 0; trial < 3000; ++trial) {
                const PantographState state = kinematics.locate(random_pose(kinematics, random));
                Wrench wrench = random_wrench(random, 15.0, 0.6);
                const TorqueSolution solution = joint_torques(kinematics, state, wrench);
                if (kinematics.freedoms() == 2)
                    wrench.z() = 0.0;
                const Wrench given = state.rates.transpose() * solution.torque;
                REQUIRE((given - solution.scale * wrench).norm() < 1.0e-9);
                for (int i = 0; i < kinematics.motors(); ++i)
                    REQUIRE(std::abs(solution.torque[i]) <= geometry.joint_torque_limit(i) * (1.0 + 1.0e-12));
                scaled += solution.scale < 1.0 ? 1 : 0;
            }
            CHECK(scaled > 100);
        }
    }

    TEST_CASE("no other torques within limits are smaller, and no larger share fits") {
        Random random(12);
        const PantographKinematics kinematics(ubc_twin_pantograph());
        int inside = 0;
        int at_bound = 0;
        int scaled = 0;
        for (int trial = 0; trial < 3000; ++trial) {
            const PantographState state = kinematics.locate(random_pose(kinematics, random));
            const Wrench wrench = random_wrench(random, 10.0, 0.5);
            const TorqueSolution solution = joint_torques(kinematics, state, wrench);
            const double limit = kinematics.geometry().joint_torque_limit(0);
            const Eigen::Vector4d along = null_vector(state.rates);
            const double norm = solution.torque.norm();
            const double peak = solution.torque.cwiseAbs().maxCoeff();
            for (double step = -0.5; step <= 0.5; step += 1.0e-3) {
                const Eigen::Vector4d other = solution.torque + step * along;
                if (solution.scale <
                    1.0) // the peak is at the limit: a flatter solution would let more through
                    REQUIRE(other.cwiseAbs().maxCoeff() >= peak - 1.0e-9);
                else if (other.cwiseAbs().maxCoeff() <= limit)
                    REQUIRE(other.norm() >= norm - 1.0e-9);
            }
            if (solution.scale < 1.0)
                ++scaled;
            else
                ++(peak > limit * (1.0 - 1.0e-9) ? at_bound : inside);
        }
        CHECK(inside > 100);
        CHECK(at_bound > 20);
        CHECK(scaled > 100);
    }

    TEST_CASE("torques are continuous as a wrench grows out of what the motors can give") {
        Random random(13);
        const PantographKinematics kinematics(ubc_twin_pantograph());
        for (int trial = 0; trial < 200; ++trial) {
            const PantographState state = kinematics.locate(random_pose(kinematics, random));
            const Wrench direction = random_wrench(random, 10.0, 0.5);
            // how fast they may move: the least-norm torques, plus what keeps one of them at its limit along
            // the null direction
            const Eigen::Vector4d along = null_vector(state.rates);
            const Eigen::MatrixXd map = state.rates.transpose();
            const double size = shared::least_squares(map, direction).norm();
            const double step = 1.0e-3;
            const double bound = 2.0 * step * size * (1.0 + 1.0 / along.cwiseAbs().minCoeff());
            JointVector last = JointVector::Zero();
            for (double share = 0.0; share < 3.0; share += step) {
                const JointVector torque = joint_torques(kinematics, state, share * direction).torque;
                REQUIRE((torque - last).norm() < bound);
                last = torque;
            }
        }
    }

    TEST_CASE("the Haply 2DIY v3 gives 1.7 N in its worst direction at the middle of its workspace") {
        const PantographKinematics kinematics(haply_2diy_v3());
        const PantographState state = kinematics.locate(Pose::Zero());
        double worst = 1.0e9;
        for (int degree = 0; degree < 360; ++degree) {
            const double angle = degree * std::numbers::pi / 180.0;
            const Wrench wrench(1.0e3 * std::cos(angle), 1.0e3 * std::sin(angle), 0.0);
            worst = std::min(worst, 1.0e3 * joint_torques(kinematics, state, wrench).scale);
        }
        CHECK(worst == doctest::Approx(1.7).epsilon(0.05));
    }

    TEST_CASE("the assumed twin gives 8 N in every direction within 80 mm of the middle") {
        const PantographKinematics kinematics(ubc_twin_pantograph());
        for (double x = -0.08; x <= 0.0801; x += 0.02)
            for (double y = -0.06; y <= 0.0601; y += 0.02)
                for (int degree = 0; degree < 360; degree += 5) {
                    const double angle = degree * std::numbers::pi / 180.0;
                    const Wrench wrench(8.0 * std::cos(angle), 8.0 * std::sin(angle), 0.0);
                    REQUIRE(joint_torques(kinematics, kinematics.locate(Pose(x, y, 0.0)), wrench).scale ==
                            1.0);
                }
    }

    TEST_CASE("singular poses and broken wrenches give finite torques") {
        const double infinity = std::numeric_limits<double>::infinity();
        const double values[] = {
            0.0, 1.0e-300, 8.0, -1.0e6, 1.0e200, -infinity, std::numeric_limits<double>::quiet_NaN()};
        Random random(14);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 200; ++trial) {
                const Pose pose(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                                random.uniform(-7.0, 7.0));
                const PantographState state = kinematics.locate(pose);
                for (const double x : values)
                    for (const double torque : values) {
                        const TorqueSolution solution =
                            joint_torques(kinematics, state, Wrench(x, -x, torque));
                        REQUIRE(solution.torque.allFinite());
                        REQUIRE(solution.scale >= 0.0);
                        REQUIRE(solution.scale <= 1.0);
                        for (int i = 0; i < kinematics.motors(); ++i)
                            REQUIRE(std::abs(solution.torque[i]) <=
                                    geometry.joint_torque_limit(i) * (1.0 + 1.0e-12));
                    }
            }
        }
    }
}
