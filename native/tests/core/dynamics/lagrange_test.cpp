#include <haptics/core/dynamics/mass_matrix.hpp>

#include "dynamics_fixture.hpp"

using namespace haptics;
using haptics::testing::Linkage;
using haptics::testing::randomize;

TEST_CASE("C + G follows from Lagrange's equations with finite differences of D and of the potential") {
    shared::Random random(17);
    double worst = 0.0;
    for (int round = 0; round < 200; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 8);
        kind.base = round % 2 == 0 ? BaseKind::grounded : BaseKind::floating;
        Linkage linkage(random_linkage(random, kind));
        randomize(linkage, random, round);
        const int n = linkage.model.freedoms;
        const LinkageVector q = linkage.data.position;
        const LinkageVector v = linkage.data.velocity;
        LinkageVector bias;
        bias_forces(linkage.model, linkage.data, bias);

        // slopes of D and of the potential along each coordinate, by sixth-order differences
        const double h = 1e-3;
        const double weights[3] = {45.0, -9.0, 1.0};
        LinkageVector expected = LinkageVector::Zero(n);
        for (int k = 0; k < n; ++k) {
            Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(n, n);
            double potential_slope = 0.0;
            for (int step = 1; step <= 3; ++step) {
                for (const double sign : {1.0, -1.0}) {
                    linkage.data.position = q;
                    linkage.data.position[k] += sign * step * h;
                    update_kinematics(linkage.model, linkage.data);
                    LinkageMatrix mass;
                    mass_matrix(linkage.model, linkage.data, mass);
                    slope += sign * weights[step - 1] / (60.0 * h) * mass;
                    potential_slope +=
                        sign * weights[step - 1] / (60.0 * h) * potential_energy(linkage.model, linkage.data);
                }
            }
            // d/dt (D v) - grad (v.D v / 2) + grad V at zero acceleration
            expected += slope * v * v[k];
            expected[k] += -0.5 * v.dot(slope * v) + potential_slope;
        }
        worst = std::max(worst, (bias - expected).cwiseAbs().maxCoeff() / (1.0 + bias.cwiseAbs().maxCoeff()));
    }
    CHECK(worst < 1e-8);
}

TEST_CASE("kinetic energy is v.D v / 2 and momentum is that of all links") {
    shared::Random random(18);
    double worst = 0.0;
    for (int round = 0; round < 500; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 12);
        kind.base = round % 2 == 0 ? BaseKind::grounded : BaseKind::floating;
        Linkage linkage(random_linkage(random, kind));
        randomize(linkage, random, round);
        const LinkageModel& model = linkage.model;
        LinkageMatrix mass;
        mass_matrix(model, linkage.data, mass);
        const double expected = 0.5 * linkage.data.velocity.dot(mass * linkage.data.velocity);
        worst = std::max(worst, std::fabs(kinetic_energy(model, linkage.data) - expected) / expected);
        Momentum sum;
        for (int link = 0; link < model.link_count; ++link) {
            const Vec2 center = link_center_pose(model, linkage.data, link).head<2>();
            const Twist twist = point_velocity(model, linkage.data, link, center);
            sum.linear += model.link[link].mass * twist.head<2>();
            sum.angular +=
                model.link[link].inertia * twist.z() + model.link[link].mass * cross(center, twist.head<2>());
        }
        const Momentum total = total_momentum(model, linkage.data);
        worst = std::max(worst, (total.linear - sum.linear).norm() / (1e-3 + sum.linear.norm()));
        worst = std::max(worst, std::fabs(total.angular - sum.angular) / (1e-3 + std::fabs(sum.angular)));
    }
    CHECK(worst < 1e-12);
}
