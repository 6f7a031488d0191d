#include <haptics/core/dynamics/sincos.hpp>

#include "dynamics_fixture.hpp"

using namespace haptics;
using haptics::testing::Linkage;
using haptics::testing::randomize;

namespace {

/// Pose of the material point of `link` that has the given local coordinates, at position q.
Vec3 pose_at(Linkage& linkage, const LinkageVector& position, int link, const Vec2& local) {
    linkage.data.position = position;
    update_kinematics(linkage.model, linkage.data);
    const Vec2 point = link_point(linkage.model, linkage.data, link, local);
    return {point.x(), point.y(), link_pose(linkage.model, linkage.data, link).z()};
}

/// Sixth-order central difference.
template <class Function>
Vec3 derivative(const Function& function, double h) {
    return (45.0 * (function(h) - function(-h)) - 9.0 * (function(2.0 * h) - function(-2.0 * h)) +
            (function(3.0 * h) - function(-3.0 * h))) /
           (60.0 * h);
}

} // namespace

TEST_CASE("fast sine and cosine are within 2e-16 of the C library over the whole range") {
    shared::Random random(3);
    double worst = 0.0;
    for (int round = 0; round < 200000; ++round) {
        const double x = random.uniform(-1.0, 1.0) * (round % 2 == 0 ? 10.0 : 1e6);
        double s = 0.0;
        double c = 0.0;
        fast_sincos(x, s, c);
        worst = std::max({worst, std::fabs(s - std::sin(x)), std::fabs(c - std::cos(x))});
    }
    CHECK(worst <= 2.3e-16);
    double s = 0.0;
    double c = 0.0;
    fast_sincos(1e9, s, c);
    CHECK(s == std::sin(1e9));
    fast_sincos(0.0, s, c);
    CHECK(s == 0.0);
    CHECK(c == 1.0);
    fast_sincos(std::numeric_limits<double>::quiet_NaN(), s, c);
    CHECK(std::isnan(s));
}

TEST_CASE("Jacobians, their products and J' q' match finite differences to 1e-8 on random trees") {
    shared::Random random(1);
    double worst_jacobian = 0.0;
    double worst_bias = 0.0;
    double worst_velocity = 0.0;
    for (int round = 0; round < 300; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 12);
        kind.base = round % 2 == 0 ? BaseKind::grounded : BaseKind::floating;
        Linkage linkage(random_linkage(random, kind));
        randomize(linkage, random, round);
        const LinkageModel& model = linkage.model;
        const int link = random.integer(0, model.link_count - 1);
        const Vec2 local(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
        const LinkageVector q = linkage.data.position;
        const LinkageVector v = linkage.data.velocity;
        const Vec2 point = link_point(model, linkage.data, link, local);
        PointJacobian jacobian;
        point_jacobian(model, linkage.data, link, point, jacobian);
        const Twist twist = point_velocity(model, linkage.data, link, point);
        const Twist bias = point_bias(model, linkage.data, link, point);
        worst_velocity = std::max(worst_velocity, (jacobian * v - twist).cwiseAbs().maxCoeff());
        worst_velocity =
            std::max(worst_velocity,
                     (apply_jacobian(model, linkage.data, link, point, v) - twist).cwiseAbs().maxCoeff());
        const Wrench wrench(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        LinkageVector force;
        force.setZero(model.freedoms);
        add_wrench(model, linkage.data, link, point, wrench, force);
        worst_velocity =
            std::max(worst_velocity, (force - jacobian.transpose() * wrench).cwiseAbs().maxCoeff());
        LinkageVector row;
        direction_row(model, linkage.data, link, point, wrench, row);
        CHECK(row == force);

        for (int i = 0; i < model.freedoms; ++i) {
            const Vec3 column = derivative(
                [&](double h) {
                    LinkageVector moved = q;
                    moved[i] += h;
                    return pose_at(linkage, moved, link, local);
                },
                1e-3);
            worst_jacobian = std::max(worst_jacobian, (column - jacobian.col(i)).cwiseAbs().maxCoeff());
        }
        // J' q' is the rate of J q' along the motion with constant q'
        const Vec3 rate = derivative(
            [&](double h) -> Vec3 {
                const LinkageVector moved = q + h * v;
                const Vec3 pose = pose_at(linkage, moved, link, local);
                PointJacobian there;
                point_jacobian(model, linkage.data, link, pose.head<2>(), there);
                return there * v;
            },
            2e-4);
        worst_bias =
            std::max(worst_bias, (rate - bias).cwiseAbs().maxCoeff() / (1.0 + bias.cwiseAbs().maxCoeff()));
    }
    CHECK(worst_jacobian < 1e-8);
    CHECK(worst_bias < 1e-8);
    CHECK(worst_velocity < 1e-12);
}

TEST_CASE("links fixed to another move with it, and a link fixed to the ground stands still") {
    LinkageSpec spec = shared::arm();
    LinkSpec tip = shared::rod(2, 0.05, 0.02);
    tip.joint.kind = JointKind::fixed;
    tip.joint.frame = {0.1, 0.0, 0.5};
    spec.links.push_back(tip);
    LinkSpec stand = shared::rod(-1, 0.1, 1.0);
    stand.joint.kind = JointKind::fixed;
    stand.joint.frame = {0.3, 0.4, 0.1};
    spec.links.push_back(stand);
    Linkage linkage(spec);
    CHECK(linkage.model.freedoms == 3);
    linkage.data.position << 0.2, 0.3, 0.4;
    linkage.data.velocity << 1.0, 2.0, 3.0;
    update_kinematics(linkage.model, linkage.data);
    const Pose parent = link_pose(linkage.model, linkage.data, 2);
    const Pose child = link_pose(linkage.model, linkage.data, 3);
    CHECK(child.z() == doctest::Approx(0.2 + 0.3 + 0.4 + 0.5));
    CHECK((child.head<2>() - Transform(parent).apply({0.1, 0.0})).norm() < 1e-15);
    const Pose ground = link_pose(linkage.model, linkage.data, 4);
    CHECK((ground - Pose(0.3, 0.4, 0.1)).norm() < 1e-15);
    CHECK(point_velocity(linkage.model, linkage.data, 4, ground.head<2>()).isZero(0.0));
}
