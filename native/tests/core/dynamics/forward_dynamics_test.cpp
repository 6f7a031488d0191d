#include <haptics/core/dynamics/closed_chain.hpp>
#include <haptics/core/dynamics/dense_dynamics.hpp>
#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/mass_inverse.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include "dynamics_fixture.hpp"

using namespace haptics;
using haptics::testing::Linkage;
using haptics::testing::random_vector;
using haptics::testing::randomize;

namespace {

/// Error of `acceleration` as a solution of D a = force - C - G, relative to the size of the terms:
/// independent of D's condition.
double backward_error(const Linkage& linkage, const LinkageVector& force, const LinkageVector& acceleration) {
    const LinkageMatrix mass = haptics::testing::summed_mass_matrix(linkage);
    const LinkageVector bias = haptics::testing::summed_bias(linkage);
    const LinkageVector residual = mass * acceleration + bias - force;
    const LinkageVector scale =
        mass.cwiseAbs() * acceleration.cwiseAbs() + bias.cwiseAbs() + force.cwiseAbs();
    return residual.cwiseAbs().maxCoeff() / scale.maxCoeff();
}

double relative_error(const LinkageVector& value, const LinkageVector& truth) {
    return (value - truth).cwiseAbs().maxCoeff() / truth.cwiseAbs().maxCoeff();
}

/// Condition of the mass matrix with its rows and columns scaled to a unit diagonal (units cancel).
double condition(const Linkage& linkage) {
    LinkageMatrix mass = haptics::testing::summed_mass_matrix(linkage);
    const LinkageVector scale = mass.diagonal().cwiseSqrt().cwiseInverse();
    mass = (scale.asDiagonal() * mass * scale.asDiagonal()).eval();
    const Eigen::VectorXd values = shared::symmetric_eigenvalues(mass);
    return values.maxCoeff() / values.minCoeff();
}

} // namespace

TEST_CASE("the composite mass matrix and Newton-Euler bias equal the sums over Jacobians") {
    shared::Random random(11);
    double worst = 0.0;
    for (int round = 0; round < 1000; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 12);
        kind.base = round % 2 == 0 ? BaseKind::grounded : BaseKind::floating;
        LinkageSpec spec = random_linkage(random, kind);
        spec.coriolis = round % 3 != 0;
        Linkage linkage(spec);
        randomize(linkage, random, round);
        LinkageMatrix mass;
        mass_matrix(linkage.model, linkage.data, mass);
        const LinkageMatrix truth = haptics::testing::summed_mass_matrix(linkage);
        worst = std::max(worst, (mass - truth).cwiseAbs().maxCoeff() / truth.cwiseAbs().maxCoeff());
        LinkageVector bias;
        bias_forces(linkage.model, linkage.data, bias);
        const LinkageVector bias_truth = haptics::testing::summed_bias(linkage);
        worst = std::max(worst, (bias - bias_truth).cwiseAbs().maxCoeff() /
                                    (1e-3 + bias_truth.cwiseAbs().maxCoeff()));
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("dense, articulated and chosen kernels agree on thousands of random trees, stretched and folded "
          "ones too") {
    shared::Random random(5);
    double worst_backward = 0.0;
    double worst_small = 0.0;
    double worst_scaled = 0.0;
    for (int round = 0; round < 4000; ++round) {
        shared::RandomLinkage kind;
        kind.links = round % 10 == 0 ? random.integer(13, 48) : random.integer(1, 12);
        kind.base = random.integer(0, 1) == 0 ? BaseKind::grounded : BaseKind::floating;
        kind.serial = random.integer(0, 1) == 0;
        if (random.integer(0, 1) == 0) {
            kind.prismatic = 0.0;
            kind.fixed = 0.0;
        }
        LinkageSpec spec = random_linkage(random, kind);
        spec.coriolis = round % 5 != 0;
        Linkage linkage(spec);
        randomize(linkage, random, round);
        const LinkageVector force = random_vector(random, linkage.model.freedoms, 2.0);
        DenseDynamics dense;
        LinkageVector truth;
        dense_acceleration(linkage.model, linkage.data, force, nullptr, dense, truth);
        ArticulatedFactor factor;
        LinkageVector articulated;
        articulated_acceleration(linkage.model, linkage.data, force, nullptr, factor, articulated);
        LinkageVector chosen;
        forward_dynamics(linkage.model, linkage.data, force, factor, chosen);
        worst_backward =
            std::max({worst_backward, backward_error(linkage, force, truth),
                      backward_error(linkage, force, articulated), backward_error(linkage, force, chosen)});
        const double difference = std::max(relative_error(articulated, truth), relative_error(chosen, truth));
        const double floor = condition(linkage) * 1e-16;
        worst_scaled = std::max(worst_scaled, difference / std::max(floor, 1e-13));
        if (floor < 1e-14) {
            worst_small = std::max(worst_small, difference);
        }
    }
    MESSAGE("backward error " << worst_backward << ", relative difference where cond(D) < 100: "
                              << worst_small << ", in units of cond(D) 1e-16: " << worst_scaled);
    CHECK(worst_backward < 1e-12);
    CHECK(worst_small < 1e-12);
    CHECK(worst_scaled < 20.0);
}

TEST_CASE(
    "grounded revolute chains of 1 to 4 bodies run in closed form and equal the dense method to 1e-12") {
    shared::Random random(7);
    for (int links = 1; links <= 4; ++links) {
        double worst = 0.0;
        for (int round = 0; round < 1000; ++round) {
            shared::RandomLinkage kind;
            kind.links = links;
            kind.serial = true;
            kind.prismatic = 0.0;
            kind.fixed = 0.0;
            LinkageSpec spec = random_linkage(random, kind);
            spec.coriolis = round % 5 != 0;
            Linkage linkage(spec);
            REQUIRE(linkage.model.kernel == DynamicsKernel::closed_chain);
            randomize(linkage, random, round);
            const LinkageVector force = random_vector(random, links, 1.0);
            DenseDynamics dense;
            LinkageVector truth;
            dense_acceleration(linkage.model, linkage.data, force, nullptr, dense, truth);
            LinkageVector closed;
            closed_chain_acceleration(linkage.model, linkage.data, force, closed);
            worst = std::max(worst, relative_error(closed, truth));
        }
        CHECK(worst < 1e-12);
    }
}

TEST_CASE("an added diagonal is the same in the dense and the articulated method") {
    shared::Random random(23);
    double worst = 0.0;
    for (int round = 0; round < 1000; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 10);
        kind.base = random.integer(0, 1) == 0 ? BaseKind::grounded : BaseKind::floating;
        Linkage linkage(random_linkage(random, kind));
        randomize(linkage, random, round);
        const LinkageVector force = random_vector(random, linkage.model.freedoms, 2.0);
        const LinkageVector added = random_vector(random, linkage.model.freedoms, 1e-2).cwiseAbs();
        DenseDynamics dense;
        LinkageVector truth;
        dense_acceleration(linkage.model, linkage.data, force, &added, dense, truth);
        ArticulatedFactor factor;
        LinkageVector fast;
        articulated_acceleration(linkage.model, linkage.data, force, &added, factor, fast);
        worst = std::max(worst, relative_error(fast, truth));
    }
    CHECK(worst < 1e-11);
}

TEST_CASE("D^-1 applied to vectors and rows, dense D^-1 and J D^-1 J^T equal Eigen's") {
    shared::Random random(29);
    double worst = 0.0;
    for (int round = 0; round < 500; ++round) {
        shared::RandomLinkage kind;
        kind.links = random.integer(1, 10);
        kind.base = random.integer(0, 1) == 0 ? BaseKind::grounded : BaseKind::floating;
        Linkage linkage(random_linkage(random, kind));
        randomize(linkage, random, round);
        const int n = linkage.model.freedoms;
        LinkageMatrix mass;
        mass_matrix(linkage.model, linkage.data, mass);
        const Eigen::MatrixXd truth = shared::inverse(mass);
        ArticulatedFactor factor;
        factorize(linkage.model, linkage.data, nullptr, factor);
        LinkageMatrix inverse;
        inverse_mass_matrix(linkage.model, linkage.data, factor, inverse);
        worst = std::max(worst, (inverse - truth).cwiseAbs().maxCoeff() / truth.cwiseAbs().maxCoeff());
        CHECK(inverse == inverse.transpose());
        PointJacobian jacobian;
        point_jacobian(linkage.model, linkage.data, linkage.model.link_count - 1, Vec2(0.1, 0.2), jacobian);
        Eigen::MatrixXd solutions(n, 3);
        solve_rows(linkage.model, linkage.data, factor, jacobian, solutions);
        Mat3 operational;
        operational_inverse(jacobian, solutions, operational);
        const Mat3 expected = jacobian * truth * jacobian.transpose();
        if (expected.cwiseAbs().maxCoeff() > 0.0) {
            worst = std::max(worst,
                             (operational - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
        }
    }
    CHECK(worst < 1e-10);
}
