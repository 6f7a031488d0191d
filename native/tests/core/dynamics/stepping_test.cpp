#include <haptics/core/dynamics/dense_dynamics.hpp>
#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/integrators/adams_bashforth4.hpp>
#include <haptics/core/dynamics/integrators/dormand_prince8.hpp>
#include <haptics/core/dynamics/integrators/linkage_motion.hpp>
#include <haptics/core/dynamics/integrators/semi_implicit_euler.hpp>
#include <haptics/core/dynamics/joint_rows.hpp>
#include <haptics/core/dynamics/mass_inverse.hpp>

#include <cstring>

#include "dynamics_fixture.hpp"
#include "support/allocation_guard.hpp"

using namespace haptics;
using haptics::testing::AllocationGuard;
using haptics::testing::Linkage;

namespace {

/// One of each kernel, and a tree.
std::vector<LinkageSpec> every_kernel() {
    shared::Random random(41);
    shared::RandomLinkage tree;
    tree.links = 40;
    return {shared::rigid_tool(),
            shared::door(),
            shared::chain(2),
            shared::arm(),
            shared::chain(4),
            shared::chain(48),
            shared::chain(33, BaseKind::floating),
            random_linkage(random, tree)};
}

/// FNV-1a over the bits of the numbers.
std::uint64_t hash(std::uint64_t seed, const LinkageVector& numbers) {
    for (const double number : numbers) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &number, sizeof(bits));
        for (int byte = 0; byte < 8; ++byte) {
            seed = (seed ^ ((bits >> (8 * byte)) & 255U)) * 1099511628211ULL;
        }
    }
    return seed;
}

} // namespace

TEST_CASE("no stepping function of the dynamics takes or gives back memory") {
    for (const LinkageSpec& spec : every_kernel()) {
        Linkage linkage(spec);
        const auto dense = std::make_unique<DenseDynamics>();
        const auto factor = std::make_unique<ArticulatedFactor>();
        const auto inverse = std::make_unique<LinkageMatrix>();
        const auto eighth = std::make_unique<DormandPrince8>();
        const auto fourth = std::make_unique<AdamsBashforth4>();
        const auto first = std::make_unique<SemiImplicitEuler>();
        const auto motion = std::make_unique<LinkageMotion>(linkage.model, linkage.data);
        const int n = linkage.model.freedoms;
        LinkageVector force = LinkageVector::Constant(n, 0.01);
        LinkageVector acceleration;
        LinkageVector added = LinkageVector::Constant(n, 1e-3);
        PointJacobian jacobian;
        Eigen::MatrixXd solutions(n, 3);
        Mat3 operational;
        LimitRows limits;
        StateVector y = StateVector::Zero(2 * n);

        const AllocationGuard guard;
        update_kinematics(linkage.model, linkage.data);
        add_joint_forces(linkage.model, linkage.data, force);
        forward_dynamics(linkage.model, linkage.data, force, *factor, acceleration);
        step_semi_implicit(linkage.model, linkage.data, force, 1e-3, *factor, acceleration);
        update_kinematics(linkage.model, linkage.data);
        articulated_acceleration(linkage.model, linkage.data, force, &added, *factor, acceleration);
        dense_acceleration(linkage.model, linkage.data, force, &added, *dense, acceleration);
        factorize(linkage.model, linkage.data, nullptr, *factor);
        inverse_mass_matrix(linkage.model, linkage.data, *factor, *inverse);
        point_jacobian(linkage.model, linkage.data, 0, Vec2(0.1, 0.0), jacobian);
        solve_rows(linkage.model, linkage.data, *factor, jacobian, solutions);
        operational_inverse(jacobian, solutions, operational);
        limit_rows(linkage.model, linkage.data, 0.1, limits);
        for (int i = 0; i < 5; ++i) {
            eighth->step(*motion, 0.0, 1e-3, y);
            fourth->step(*motion, 0.0, 1e-3, y);
            first->step(*motion, 0.0, 1e-3, y);
        }
        CHECK(guard.allocations() == 0);
        CHECK(guard.deallocations() == 0);
    }
}

TEST_CASE("the semi-implicit step is the same as forward dynamics followed by the update") {
    for (const LinkageSpec& spec : every_kernel()) {
        Linkage fused(spec);
        Linkage apart(spec);
        const auto factor = std::make_unique<ArticulatedFactor>();
        const int n = fused.model.freedoms;
        const LinkageVector force = LinkageVector::Constant(n, 1e-4);
        LinkageVector acceleration;
        for (int i = 0; i < 100; ++i) {
            step_semi_implicit(fused.model, fused.data, force, 1e-3, *factor, acceleration);
            prepare_dynamics(apart.model, apart.data);
            forward_dynamics(apart.model, apart.data, force, *factor, acceleration);
            apart.data.velocity += 1e-3 * acceleration;
            apart.data.position += 1e-3 * apart.data.velocity;
        }
        CHECK((fused.data.position - apart.data.position).cwiseAbs().maxCoeff() < 1e-11);
    }
}

TEST_CASE("a thousand steps of every kernel give the same bits in every build and on every machine") {
    std::uint64_t result = 14695981039346656037ULL;
    for (const LinkageSpec& spec : every_kernel()) {
        Linkage linkage(spec);
        const auto factor = std::make_unique<ArticulatedFactor>();
        LinkageVector force(linkage.model.freedoms);
        for (int i = 0; i < linkage.model.freedoms; ++i) {
            force[i] = 1e-4 * (i % 5 - 2);
        }
        LinkageVector acceleration;
        for (int i = 0; i < 1000; ++i) {
            step_semi_implicit(linkage.model, linkage.data, force, 1e-3, *factor, acceleration);
        }
        result = hash(hash(result, linkage.data.position), linkage.data.velocity);
    }
    MESSAGE("hash " << result);
    CHECK(result == 14609164133562050212ULL);
}
