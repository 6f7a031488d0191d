#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/pantograph/poses.hpp"

using namespace haptics;
using haptics::testing::all_presets;
using haptics::testing::Random;
using haptics::testing::random_pose;

TEST_SUITE("pantograph kinematics") {
    TEST_CASE("the loops close: every link keeps its length, in every preset") {
        Random random(1);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 2000; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                JointVector angles;
                REQUIRE(kinematics.inverse(pose, angles));
                // elbows from the angles alone, end points from the pose alone
                for (int i = 0; i < kinematics.motors(); ++i) {
                    const auto b = static_cast<std::size_t>(i / 2);
                    const auto k = static_cast<std::size_t>(i % 2);
                    const FiveBarGeometry& bar = geometry.bar[b];
                    const Vec2 base =
                        bar.base_center +
                        rotate(bar.base_angle, Vec2((k == 0 ? -0.5 : 0.5) * bar.base_spacing, 0.0));
                    const Vec2 elbow = base + rotate(angles[i], Vec2(bar.proximal_length[k], 0.0));
                    const Vec2 end = pose.head<2>() + rotate(pose.z(), geometry.attachment[b]);
                    REQUIRE(std::abs((end - elbow).norm() - bar.distal_length[k]) < 1.0e-12);
                }
            }
        }
    }

    TEST_CASE("forward undoes inverse, with no residual") {
        Random random(2);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 2000; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                JointVector angles;
                kinematics.inverse(pose, angles);
                // whole turns must not matter
                angles[0] += 2.0 * std::numbers::pi;
                const PoseEstimate estimate = kinematics.forward(angles);
                REQUIRE(estimate.valid);
                REQUIRE((estimate.pose - pose).norm() < 1.0e-11);
                REQUIRE(estimate.residual < 1.0e-11);
            }
        }
    }

    TEST_CASE("rates agree with differences of the inverse kinematics to 1e-8") {
        Random random(3);
        double worst = 0.0;
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 1000; ++trial) {
                const Pose pose = random_pose(kinematics, random);
                const JointJacobian rates = kinematics.locate(pose).rates;
                for (int axis = 0; axis < kinematics.freedoms(); ++axis) {
                    // eighth-order central difference
                    constexpr double k_weight[4] = {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
                    const double h = axis == 2 ? 2.0e-3 : 1.0e-4;
                    JointVector slope = JointVector::Zero();
                    for (int n = 0; n < 4; ++n) {
                        Pose ahead = pose;
                        Pose behind = pose;
                        ahead[axis] += (n + 1) * h;
                        behind[axis] -= (n + 1) * h;
                        JointVector after;
                        JointVector before;
                        kinematics.inverse(ahead, after);
                        kinematics.inverse(behind, before);
                        for (int i = 0; i < 4; ++i)
                            slope[i] += k_weight[n] *
                                        std::remainder(after[i] - before[i], 2.0 * std::numbers::pi) / h;
                    }
                    const double scale = std::max(1.0, rates.col(axis).norm());
                    worst = std::max(worst, (slope - rates.col(axis)).norm() / scale);
                }
            }
        }
        MESSAGE("worst relative difference " << worst);
        CHECK(worst < 1.0e-8);
    }

    TEST_CASE("the twist Jacobian inverts the rates") {
        Random random(4);
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (int trial = 0; trial < 500; ++trial) {
                const PantographState state = kinematics.locate(random_pose(kinematics, random));
                Mat3 one = kinematics.jacobian(state) * state.rates;
                if (kinematics.freedoms() == 2)
                    one(2, 2) = 1.0;
                REQUIRE((one - Mat3::Identity()).norm() < 1.0e-9);
            }
        }
    }

    TEST_CASE("four noisy encoders give the least-squares pose") {
        Random random(5);
        const PantographKinematics kinematics(ubc_twin_pantograph());
        for (int trial = 0; trial < 500; ++trial) {
            const Pose pose = random_pose(kinematics, random);
            JointVector angles;
            kinematics.inverse(pose, angles);
            for (int i = 0; i < 4; ++i)
                angles[i] += random.uniform(-1.0e-3, 1.0e-3);
            const PoseEstimate estimate = kinematics.forward(angles);
            REQUIRE(estimate.valid);
            const auto cost = [&](const Pose& at) {
                JointVector there;
                kinematics.inverse(at, there);
                return (angles - there).norm();
            };
            CHECK(cost(estimate.pose) == doctest::Approx(estimate.residual).epsilon(1.0e-9));
            // no neighbor explains the encoders better
            for (int axis = 0; axis < 3; ++axis)
                for (const double step : {-1.0e-5, 1.0e-5}) {
                    Pose other = estimate.pose;
                    other[axis] += step;
                    REQUIRE(cost(other) > estimate.residual);
                }
        }
    }

    TEST_CASE("a slipped encoder shows in the residual as far as the linkage can tell") {
        // To first order only the part of the slip along the one direction n that no motion explains remains:
        // slip |n_i|.
        Random random(6);
        const PantographKinematics kinematics(ubc_twin_pantograph());
        const double slip = 0.002;
        int visible = 0;
        int all = 0;
        for (int trial = 0; trial < 500; ++trial) {
            const Pose pose = random_pose(kinematics, random);
            const Eigen::Vector4d unexplained =
                shared::kernel(kinematics.locate(pose).rates.transpose()).col(0);
            for (int axis = 0; axis < 4; ++axis) {
                JointVector angles;
                kinematics.inverse(pose, angles);
                angles[axis] += slip;
                const double residual = kinematics.forward(angles).residual;
                REQUIRE(std::abs(residual - slip * std::abs(unexplained[axis])) < 0.05 * slip);
                visible += residual > 0.2 * slip ? 1 : 0;
                ++all;
            }
        }
        MESSAGE("share of slips with a residual above a fifth: " << static_cast<double>(visible) / all);
        CHECK(visible > all / 2);
    }

    TEST_CASE("reach ends where the arm is stretched, and rates grow towards it") {
        const PantographKinematics kinematics(haply_2diy_v2());
        // coaxial arms reach 160 mm from the axis at (0, -100 mm)
        const Pose inside(0.0, 0.0599, 0.0);
        const Pose outside(0.0, 0.0601, 0.0);
        CHECK(kinematics.workspace(inside).reach_margin == doctest::Approx(1.0e-4));
        CHECK(kinematics.workspace(outside).reach_margin == doctest::Approx(-1.0e-4));
        CHECK_FALSE(kinematics.workspace(outside).inside);
        CHECK(kinematics.locate(inside).rates.norm() > 5.0 * kinematics.locate(Pose::Zero()).rates.norm());
    }

    TEST_CASE("the singularity measure vanishes where no wrench holds a direction") {
        const PantographKinematics kinematics(pantograph_mk2());
        // elbows 2 L apart: the end point lies between them; found by walking down the middle line
        double least = 1.0;
        for (double y = 0.0; y > -0.09; y -= 1.0e-4)
            least = std::min(least, kinematics.workspace(Pose(0.0, y, 0.0)).singularity);
        CHECK(least < 0.05);
        CHECK(kinematics.workspace(Pose::Zero()).singularity > 0.5);
    }

    TEST_CASE("every input gives finite figures") {
        const double infinity = std::numeric_limits<double>::infinity();
        const double values[] = {
            0.0,      -0.0,    1.0e-300,  1.0e-9,   0.03,
            0.2,      -0.2,    1.0,       -1.0e3,   1.0e9,
            -1.0e150, 1.0e300, -infinity, infinity, std::numeric_limits<double>::quiet_NaN()};
        for (const PantographGeometry& geometry : all_presets()) {
            const PantographKinematics kinematics(geometry);
            for (const double x : values)
                for (const double y : values)
                    for (const double theta : values) {
                        const Pose pose(x, y, theta);
                        const PantographState state = kinematics.locate(pose);
                        REQUIRE(state.rates.allFinite());
                        REQUIRE(std::isfinite(state.reach_margin));
                        const WorkspaceReport report = kinematics.workspace(pose, state);
                        REQUIRE(std::isfinite(report.singularity));
                        REQUIRE(std::isfinite(report.rotation_margin));
                        REQUIRE(kinematics.jacobian(state).allFinite());
                        JointVector angles;
                        kinematics.inverse(pose, angles);
                        REQUIRE(angles.allFinite());
                        const PoseEstimate estimate = kinematics.forward(JointVector(x, y, theta, x));
                        REQUIRE(estimate.pose.allFinite());
                        REQUIRE(std::isfinite(estimate.residual));
                    }
        }
    }
}
