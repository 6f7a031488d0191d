// Torques and inertia on geometries that nobody designed. The truth for the torques is an exhaustive search
// over all ways in which motors can be at their limits; for the inertia, energies of parts that are moved
// with no Jacobian.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/pantograph/random_geometry.hpp"

using namespace haptics;
using haptics::testing::pose_near_home;
using haptics::testing::Random;
using haptics::testing::random_geometry;

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

Eigen::Vector4d limits_of(const PantographKinematics& kinematics) {
    Eigen::Vector4d limits;
    for (int i = 0; i < 4; ++i)
        limits[i] = kinematics.geometry().joint_torque_limit(i);
    return limits;
}

// least sum of (torque over limit)^2 with rates^T torque = wrench and |torque| <= limit: every motor free, at
// +limit or at -limit, 81 ways; infinity when none fits
double least_cost(const JointJacobian& rates, const Wrench& wrench, const Eigen::Vector4d& limits) {
    double best = k_infinity;
    for (int way = 0; way < 81; ++way) {
        std::array<int, 4> at{};
        int code = way;
        int free_count = 0;
        for (int& a : at) {
            a = code % 3 - 1;
            code /= 3;
            free_count += a == 0 ? 1 : 0;
        }
        Wrench left = wrench;
        Eigen::Vector4d u = Eigen::Vector4d::Zero();
        Eigen::MatrixXd map(3, free_count);
        for (int i = 0, c = 0; i < 4; ++i) {
            const Eigen::Vector3d column = rates.row(i).transpose() * limits[i];
            u[i] = at[static_cast<std::size_t>(i)];
            if (at[static_cast<std::size_t>(i)] != 0)
                left -= u[i] * column;
            else
                map.col(c++) = column;
        }
        if (free_count > 0) {
            const Eigen::VectorXd found = shared::least_squares(map, left);
            left -= map * found;
            for (int i = 0, c = 0; i < 4; ++i)
                if (at[static_cast<std::size_t>(i)] == 0)
                    u[i] = found[c++];
        }
        if (left.norm() < 1.0e-9 * (1.0 + wrench.norm()) && u.cwiseAbs().maxCoeff() <= 1.0 + 1.0e-9)
            best = std::min(best, u.squaredNorm());
    }
    return best;
}

// largest share of the wrench within limits: a corner of the box, where two motors are at their limits
double largest_share(const JointJacobian& rates, const Wrench& wrench, const Eigen::Vector4d& limits) {
    double best = 0.0;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
            for (const double sign_i : {-1.0, 1.0})
                for (const double sign_j : {-1.0, 1.0}) {
                    // unknown: the other two torques and the share
                    Mat3 system;
                    int column = 0;
                    std::array<int, 2> others{};
                    for (int m = 0; m < 4; ++m)
                        if (m != i && m != j) {
                            others[static_cast<std::size_t>(column)] = m;
                            system.col(column++) = rates.row(m).transpose() * limits[m];
                        }
                    system.col(2) = -wrench;
                    const Vec3 known = -(rates.row(i).transpose() * (sign_i * limits[i]) +
                                         rates.row(j).transpose() * (sign_j * limits[j]));
                    const Vec3 found = shared::least_squares(system, known);
                    if ((system * found - known).norm() < 1.0e-9 * (1.0 + known.norm()) &&
                        std::abs(found[0]) <= 1.0 + 1.0e-9 && std::abs(found[1]) <= 1.0 + 1.0e-9)
                        best = std::max(best, found[2]);
                }
    return best;
}

// where the parts of a leg are, without the code under test but for the elbow
struct Parts {
    Vec2 proximal;
    Vec2 distal;
    double proximal_angle;
    double distal_angle;
};
Parts parts_of(const PantographKinematics& kinematics, const Pose& pose, std::size_t i) {
    const FiveBarGeometry& bar = kinematics.geometry().bar[i / 2];
    JointVector angles;
    kinematics.inverse(pose, angles);
    const double angle = angles[static_cast<Eigen::Index>(i)];
    const Vec2 base =
        bar.base_center + rotate(bar.base_angle, Vec2((i % 2 == 0 ? -0.5 : 0.5) * bar.base_spacing, 0.0));
    const Vec2 elbow = base + rotate(angle, Vec2(bar.proximal_length[i % 2], 0.0));
    const Vec2 end = pose.head<2>() + rotate(pose.z(), kinematics.geometry().attachment[i / 2]);
    const Vec2 link = end - elbow;
    return {base + bar.proximal_center * (elbow - base), elbow + bar.distal_center * link, angle,
            std::atan2(link.y(), link.x())};
}

double energy_by_differences(const PantographKinematics& kinematics, const Pose& pose, const Twist& twist) {
    const double h = 2.0e-5;
    const PantographGeometry& g = kinematics.geometry();
    const auto rate = [h](double after, double before) {
        return std::remainder(after - before, 2.0 * std::numbers::pi) / (2.0 * h);
    };
    double energy =
        0.5 * g.handle_mass * twist.head<2>().squaredNorm() + 0.5 * g.handle_inertia * twist.z() * twist.z();
    for (std::size_t i = 0; i < static_cast<std::size_t>(kinematics.motors()); ++i) {
        const FiveBarGeometry& bar = g.bar[i / 2];
        const Parts a = parts_of(kinematics, pose - h * twist, i);
        const Parts b = parts_of(kinematics, pose + h * twist, i);
        const double joint = rate(b.proximal_angle, a.proximal_angle);
        const double distal = rate(b.distal_angle, a.distal_angle);
        energy += 0.5 * bar.proximal_mass * ((b.proximal - a.proximal) / (2.0 * h)).squaredNorm();
        energy += 0.5 * bar.distal_mass * ((b.distal - a.distal) / (2.0 * h)).squaredNorm();
        energy += 0.5 * bar.distal_inertia * distal * distal;
        energy += 0.5 * (bar.proximal_inertia + g.motor.rotor_inertia * g.gear_ratio[i] * g.gear_ratio[i]) *
                  joint * joint;
    }
    return energy;
}

} // namespace

TEST_SUITE("random pantographs") {
    TEST_CASE("torques are the least that give the wrench within limits, else the largest share: exhaustive "
              "search") {
        Random random(111);
        int inside = 0;
        int rescued = 0;
        int shared = 0;
        for (int n = 0; n < 60; ++n) {
            const PantographKinematics kinematics(random_geometry(random, 2));
            const Eigen::Vector4d limits = limits_of(kinematics);
            const double length = kinematics.characteristic_length();
            for (int k = 0; k < 40; ++k) {
                const PantographState state = kinematics.locate(pose_near_home(kinematics, random));
                // around what the motors can just give
                Wrench wrench(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                              length * random.uniform(-1.0, 1.0));
                wrench *= largest_share(state.rates, wrench, limits) * random.uniform(0.3, 1.3);
                const TorqueSolution solution = joint_torques(kinematics, state, wrench);
                const Eigen::Vector4d u = solution.torque.cwiseQuotient(limits);
                const double cost = least_cost(state.rates, wrench, limits);
                const double share = largest_share(state.rates, wrench, limits);
                if (std::abs(share - 1.0) < 1.0e-6)
                    continue;
                const Wrench given = state.rates.transpose() * solution.torque;
                REQUIRE((given - solution.scale * wrench).norm() < 1.0e-9 * (1.0 + wrench.norm()));
                if (share < 1.0) {
                    REQUIRE(cost == k_infinity);
                    REQUIRE(solution.scale == doctest::Approx(share).epsilon(1.0e-7));
                    ++shared;
                    continue;
                }
                REQUIRE(solution.scale == 1.0);
                REQUIRE(u.squaredNorm() == doctest::Approx(cost).epsilon(1.0e-7));
                // the plain least-norm torques are out of bounds: scaling them would have lost force
                const Eigen::MatrixXd map = (limits.asDiagonal() * state.rates).transpose();
                const Eigen::Vector4d plain = shared::least_squares(map, wrench);
                ++(plain.cwiseAbs().maxCoeff() > 1.0 + 1.0e-6 ? rescued : inside);
            }
        }
        MESSAGE("within limits " << inside << ", only by the redundancy " << rescued << ", shared "
                                 << shared);
        CHECK(inside > 500);
        CHECK(rescued > 100);
        CHECK(shared > 300);
    }

    TEST_CASE("two motors give the wrench, or the largest share of it") {
        Random random(112);
        for (int n = 0; n < 60; ++n) {
            const PantographKinematics kinematics(random_geometry(random, 1));
            for (int k = 0; k < 30; ++k) {
                const PantographState state = kinematics.locate(pose_near_home(kinematics, random));
                const Wrench wrench(random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0), 0.0);
                const TorqueSolution solution = joint_torques(kinematics, state, wrench);
                // virtual work of small moves
                for (int axis = 0; axis < 2; ++axis)
                    REQUIRE(solution.torque.dot(state.rates.col(axis)) ==
                            doctest::Approx(solution.scale * wrench[axis]).epsilon(1.0e-9));
                const double peak =
                    std::max(std::abs(solution.torque[0]) / kinematics.geometry().joint_torque_limit(0),
                             std::abs(solution.torque[1]) / kinematics.geometry().joint_torque_limit(1));
                REQUIRE(peak <= 1.0 + 1.0e-12);
                REQUIRE((solution.scale == 1.0 || peak == doctest::Approx(1.0)));
            }
        }
    }

    TEST_CASE("mass matrix, velocity terms and gravity agree with energies of moved parts") {
        Random random(113);
        const Vec2 gravity(3.0, -9.0);
        for (int n = 0; n < 60; ++n) {
            const PantographKinematics kinematics(random_geometry(random, 1 + n % 2));
            const int freedoms = kinematics.freedoms();
            for (int k = 0; k < 10; ++k) {
                const Pose pose = pose_near_home(kinematics, random);
                const PantographState state = kinematics.locate(pose);
                Twist twist(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-5.0, 5.0));
                if (freedoms == 2)
                    twist.z() = 0.0;
                const Mat3 mass = handle_mass_matrix(kinematics, state);
                REQUIRE(0.5 * twist.dot(mass * twist) ==
                        doctest::Approx(energy_by_differences(kinematics, pose, twist)).epsilon(1.0e-5));
                // d/dt (M v) at constant v, less the slope of the energy; steps small against the margin
                const auto mass_at = [&](const Pose& at) {
                    return handle_mass_matrix(kinematics, kinematics.locate(at));
                };
                const double h = 1.0e-6;
                Wrench expected = (mass_at(pose + h * twist) - mass_at(pose - h * twist)) * twist / (2.0 * h);
                Wrench pull = Wrench::Zero();
                for (int axis = 0; axis < freedoms; ++axis) {
                    Pose ahead = pose;
                    Pose behind = pose;
                    ahead[axis] += h;
                    behind[axis] -= h;
                    expected[axis] -= 0.5 * twist.dot((mass_at(ahead) - mass_at(behind)) * twist) / (2.0 * h);
                    double work = kinematics.geometry().handle_mass * (axis < 2 ? gravity[axis] : 0.0);
                    for (std::size_t i = 0; i < static_cast<std::size_t>(kinematics.motors()); ++i) {
                        const FiveBarGeometry& bar = kinematics.geometry().bar[i / 2];
                        const Parts a = parts_of(kinematics, behind, i);
                        const Parts b = parts_of(kinematics, ahead, i);
                        work += bar.proximal_mass * gravity.dot(b.proximal - a.proximal) / (2.0 * h);
                        work += bar.distal_mass * gravity.dot(b.distal - a.distal) / (2.0 * h);
                    }
                    pull[axis] = work;
                }
                const Wrench found = velocity_wrench(kinematics, state, twist);
                REQUIRE((found - expected).norm() < 2.0e-5 * std::max(1.0, expected.norm()));
                REQUIRE((gravity_wrench(kinematics, state, gravity) - pull).norm() < 1.0e-6);
            }
        }
    }
}
