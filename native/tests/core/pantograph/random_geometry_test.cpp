// The mechanics on geometries that nobody designed, each against a truth that shares no code with it.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pantograph/random_geometry.hpp"

using namespace haptics;
using haptics::testing::pose_near_home;
using haptics::testing::Random;
using haptics::testing::random_geometry;

namespace {

constexpr int k_geometries = 60;
constexpr int k_poses = 15;

// `check(kinematics, pose)` on many geometries of both kinds
template <typename Check>
void everywhere(std::uint64_t seed, Check&& check) {
    Random random(seed);
    for (int n = 0; n < k_geometries; ++n) {
        const PantographKinematics kinematics(random_geometry(random, 1 + n % 2));
        CAPTURE(n);
        for (int k = 0; k < k_poses; ++k)
            check(kinematics, pose_near_home(kinematics, random), random);
    }
}

// central difference of eighth order; a plain vector, no expression of temporaries
template <typename Function>
auto slope(Function&& f, double h) {
    decltype(f(h)) sum = (4.0 / 5.0) * (f(h) - f(-h));
    sum -= (1.0 / 5.0) * (f(2.0 * h) - f(-2.0 * h));
    sum += (4.0 / 105.0) * (f(3.0 * h) - f(-3.0 * h));
    sum -= (1.0 / 280.0) * (f(4.0 * h) - f(-4.0 * h));
    sum /= h;
    return sum;
}

Vec2 base_of(const PantographGeometry& g, std::size_t i) {
    const FiveBarGeometry& bar = g.bar[i / 2];
    return bar.base_center + rotate(bar.base_angle, Vec2((i % 2 == 0 ? -0.5 : 0.5) * bar.base_spacing, 0.0));
}

} // namespace

TEST_SUITE("random pantographs") {
    TEST_CASE("loops close in the working mode that the geometry names") {
        everywhere(101, [](const PantographKinematics& kinematics, const Pose& pose, Random&) {
            const PantographGeometry& g = kinematics.geometry();
            JointVector angles;
            REQUIRE(kinematics.inverse(pose, angles));
            for (std::size_t i = 0; i < static_cast<std::size_t>(kinematics.motors()); ++i) {
                const FiveBarGeometry& bar = g.bar[i / 2];
                const Vec2 base = base_of(g, i);
                const Vec2 arm =
                    rotate(angles[static_cast<Eigen::Index>(i)], Vec2(bar.proximal_length[i % 2], 0.0));
                const Vec2 end = pose.head<2>() + rotate(pose.z(), g.attachment[i / 2]);
                REQUIRE(std::abs((end - base - arm).norm() - bar.distal_length[i % 2]) < 1.0e-12);
                REQUIRE(cross(end - base, arm) * bar.elbow_side[i % 2] > 0.0);
            }
        });
    }

    TEST_CASE("forward undoes inverse, and knows angles of another working mode") {
        int mirrored = 0;
        everywhere(102, [&](const PantographKinematics& kinematics, const Pose& pose, Random& random) {
            JointVector angles;
            kinematics.inverse(pose, angles);
            const PoseEstimate estimate = kinematics.forward(angles);
            REQUIRE(estimate.valid);
            REQUIRE((estimate.pose - pose).norm() < 1.0e-10);
            REQUIRE(estimate.residual < 1.0e-10);
            REQUIRE(estimate.misfit.norm() == doctest::Approx(estimate.residual));
            // the same end point with one elbow on its other side
            PantographGeometry other = kinematics.geometry();
            const auto i = static_cast<std::size_t>(random.below(kinematics.motors()));
            other.bar[i / 2].elbow_side[i % 2] *= -1;
            JointVector flipped;
            PantographKinematics(other).inverse(pose, flipped);
            if (std::abs(std::remainder(flipped[static_cast<Eigen::Index>(i)] -
                                            angles[static_cast<Eigen::Index>(i)],
                                        2.0 * std::numbers::pi)) < 0.3)
                return;
            const PoseEstimate wrong = kinematics.forward(flipped);
            // they may belong to another pose, never to this one
            REQUIRE((!wrong.valid || wrong.residual > 1.0e-3 || (wrong.pose - pose).norm() > 1.0e-3));
            ++mirrored;
        });
        CHECK(mirrored > 300);
    }

    TEST_CASE("joint rates and twist Jacobian agree with differences to 1e-8") {
        double worst_rates = 0.0;
        double worst_twist = 0.0;
        everywhere(103, [&](const PantographKinematics& kinematics, const Pose& pose, Random&) {
            const PantographState state = kinematics.locate(pose);
            JointVector here;
            kinematics.inverse(pose, here);
            const double size = state.rates.norm();
            // steps small against the distance to the next singularity
            const double margin = std::min(state.reach_margin, 0.02);
            for (int axis = 0; axis < kinematics.freedoms(); ++axis) {
                const JointVector by_differences = slope(
                    [&](double h) {
                        Pose moved = pose;
                        moved[axis] += h;
                        JointVector there;
                        kinematics.inverse(moved, there);
                        return JointVector((there - here).unaryExpr([](double a) {
                            return std::remainder(a, 2.0 * std::numbers::pi);
                        }));
                    },
                    (axis == 2 ? 20.0 : 1.0) * 0.02 * margin);
                worst_rates = std::max(worst_rates, (by_differences - state.rates.col(axis)).norm() / size);
            }
            const Eigen::Matrix<double, 3, 4> twist = kinematics.jacobian(state);
            for (int i = 0; i < kinematics.motors(); ++i) {
                const Pose by_differences = slope(
                    [&](double h) {
                        JointVector moved = here;
                        moved[i] += h;
                        return Pose(kinematics.forward(moved).pose - pose);
                    },
                    1.0e-4);
                worst_twist = std::max(worst_twist, (by_differences - twist.col(i)).norm() / twist.norm());
            }
        });
        MESSAGE("worst relative difference: rates " << worst_rates << ", twist " << worst_twist);
        CHECK(worst_rates < 1.0e-8);
        CHECK(worst_twist < 1.0e-8);
    }

    TEST_CASE("noise of four encoders leads to the least-squares pose, a large slip too") {
        Random random(104);
        for (int n = 0; n < 40; ++n) {
            const PantographKinematics kinematics(random_geometry(random, 2));
            for (int k = 0; k < 20; ++k) {
                const Pose pose = pose_near_home(kinematics, random);
                JointVector angles;
                kinematics.inverse(pose, angles);
                const double size = k % 2 == 0 ? 1.0e-3 : 0.03;
                for (int i = 0; i < 4; ++i)
                    angles[i] += random.uniform(-size, size);
                const PoseEstimate estimate = kinematics.forward(angles);
                if (!estimate.valid)
                    continue;
                // at the least sum of squares the misfit is orthogonal to every motion
                const JointJacobian rates = kinematics.locate(estimate.pose).rates;
                REQUIRE((rates.transpose() * estimate.misfit).norm() < 1.0e-9 * rates.norm());
                const JointVector n_hat = kinematics.unexplained(kinematics.locate(estimate.pose));
                REQUIRE((rates.transpose() * n_hat).norm() < 1.0e-9 * rates.norm());
                REQUIRE(n_hat.norm() == doctest::Approx(1.0));
                REQUIRE(std::abs(n_hat.dot(estimate.misfit)) ==
                        doctest::Approx(estimate.residual).epsilon(1.0e-6));
            }
        }
    }

    TEST_CASE("every end point may move as far as the margin says, and no farther") {
        everywhere(105, [](const PantographKinematics& kinematics, const Pose& pose, Random& random) {
            const PantographGeometry& g = kinematics.geometry();
            const double margin = kinematics.workspace(pose).reach_margin;
            // largest move that every leg allows, by a walk in all directions
            const auto possible = [&](std::size_t b, const Vec2& end) {
                bool good =
                    rotate(g.bar[b].base_angle, Vec2(0.0, 1.0)).dot(end - g.bar[b].base_center) >= 0.0;
                for (std::size_t k = 0; k < 2; ++k) {
                    const double far = (end - base_of(g, 2 * b + k)).norm();
                    const double l = g.bar[b].proximal_length[k];
                    const double L = g.bar[b].distal_length[k];
                    good = good && far <= l + L && far >= std::abs(l - L);
                }
                return good;
            };
            bool blocked = false;
            const double turn = random.uniform(0.0, 0.01);
            for (std::size_t b = 0; b < static_cast<std::size_t>(g.bar_count); ++b) {
                const Vec2 end = pose.head<2>() + rotate(pose.z(), g.attachment[b]);
                for (double angle = turn; angle < 2.0 * std::numbers::pi; angle += 0.01) {
                    REQUIRE(possible(b, end + rotate(angle, Vec2(0.999 * margin, 0.0))));
                    blocked =
                        blocked || !possible(b, end + rotate(angle, Vec2(1.001 * margin + 1.0e-4, 0.0)));
                }
            }
            REQUIRE(blocked);
        });
    }

    TEST_CASE("the singularity measure is the least singular value of the lines of force") {
        everywhere(106, [](const PantographKinematics& kinematics, const Pose& pose, Random&) {
            const PantographGeometry& g = kinematics.geometry();
            const PantographState state = kinematics.locate(pose);
            Eigen::MatrixXd lines(kinematics.motors(), kinematics.freedoms());
            for (int i = 0; i < kinematics.motors(); ++i) {
                JointVector angles;
                kinematics.inverse(pose, angles);
                const auto b = static_cast<std::size_t>(i / 2);
                const Vec2 end = pose.head<2>() + rotate(pose.z(), g.attachment[b]);
                const Vec2 elbow =
                    base_of(g, static_cast<std::size_t>(i)) +
                    rotate(angles[i], Vec2(g.bar[b].proximal_length[static_cast<std::size_t>(i % 2)], 0.0));
                const Vec2 along = (end - elbow).normalized();
                lines.row(i).head<2>() = along;
                if (kinematics.freedoms() == 3)
                    lines(i, 2) = cross(end - pose.head<2>(), along) /
                                  (0.5 * (g.attachment[1] - g.attachment[0]).norm());
            }
            double least = shared::singular_values(lines).tail<1>()[0];
            // each five-bar alone, too
            for (int b = 0; b < g.bar_count; ++b) {
                least = std::min(least, shared::singular_values(lines.block<2, 2>(2 * b, 0))[1]);
            }
            REQUIRE(kinematics.workspace(pose, state).singularity == doctest::Approx(least).epsilon(1.0e-6));
        });
    }
}
