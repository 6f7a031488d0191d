#include <haptics/core/dynamics/integrators/adams_bashforth4.hpp>
#include <haptics/core/dynamics/integrators/dormand_prince8.hpp>
#include <haptics/core/dynamics/integrators/linkage_motion.hpp>
#include <haptics/core/dynamics/integrators/runge_kutta4.hpp>
#include <haptics/core/dynamics/integrators/semi_implicit_euler.hpp>

#include <algorithm>
#include <cmath>

#include "dynamics_fixture.hpp"

using namespace haptics;
using haptics::testing::Linkage;

namespace {

StateVector state_of(const Linkage& linkage) {
    StateVector y(2 * linkage.model.freedoms);
    y << linkage.data.position, linkage.data.velocity;
    return y;
}

/// Runs `steps` steps of h; the data then holds the final state with its kinematics.
template <class Integrator>
StateVector run(Linkage& linkage, int steps, double h) {
    Integrator integrator;
    const LinkageMotion motion(linkage.model, linkage.data);
    StateVector y = state_of(linkage);
    for (int i = 0; i < steps; ++i) {
        integrator.step(motion, i * h, h, y);
    }
    linkage.data.position = y.head(linkage.model.freedoms);
    linkage.data.velocity = y.tail(linkage.model.freedoms);
    update_kinematics(linkage.model, linkage.data);
    return y;
}

/// The arm in motion: the state all order tests start from.
Linkage moving_arm(bool coriolis = true) {
    LinkageSpec spec = shared::arm();
    spec.coriolis = coriolis;
    Linkage linkage(spec);
    linkage.data.position << 0.3, -0.7, 1.1;
    linkage.data.velocity << 4.0, -3.0, 6.0;
    update_kinematics(linkage.model, linkage.data);
    return linkage;
}

/// Tip position of a chain of 0.1 m rods.
Vec2 tip(const Linkage& linkage) {
    return link_point(linkage.model, linkage.data, linkage.model.link_count - 1, {0.1, 0.0});
}

/// Observed order: log2 of the ratio of the errors at h and h/2.
template <class Integrator>
double observed_order(int steps, double duration, const Vec2& truth) {
    Linkage coarse = moving_arm();
    run<Integrator>(coarse, steps, duration / steps);
    Linkage fine = moving_arm();
    run<Integrator>(fine, 2 * steps, duration / (2 * steps));
    return std::log2((tip(coarse) - truth).norm() / (tip(fine) - truth).norm());
}

} // namespace

TEST_CASE("a pendulum's period is the elliptic integral's to 1e-10") {
    LinkageSpec spec = shared::door();
    spec.gravity = {0.0, -9.81};
    Linkage pendulum(spec);
    const double amplitude = 2.0;
    pendulum.data.position[0] = -0.5 * std::numbers::pi + amplitude;
    // 4/w0 K(sin(A/2)) by the arithmetic-geometric mean; w0^2 = m g c / J
    const double inertia = 0.3 * 0.2 * 0.2 / 3.0;
    const double natural = std::sqrt(0.3 * 9.81 * 0.1 / inertia);
    double a = 1.0;
    double b = std::cos(0.5 * amplitude);
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    const double period = 2.0 * std::numbers::pi / (natural * a);
    const StateVector y = run<DormandPrince8>(pendulum, 500, period / 500);
    CHECK(std::fabs(y[0] - (-0.5 * std::numbers::pi + amplitude)) < 1e-10);
    CHECK(std::fabs(y[1]) < 1e-9);
}

TEST_CASE("each integrator has its order, and the eighth reaches 1e-12 against half its step") {
    Linkage reference = moving_arm();
    run<DormandPrince8>(reference, 4000, 0.5 / 4000);
    Linkage half = moving_arm();
    run<DormandPrince8>(half, 2000, 0.5 / 2000);
    CHECK((tip(reference) - tip(half)).norm() < 1e-12);
    const Vec2 truth = tip(reference);
    CHECK(observed_order<SemiImplicitEuler>(4000, 0.5, truth) == doctest::Approx(1.0).epsilon(0.1));
    CHECK(observed_order<AdamsBashforth4>(2000, 0.5, truth) == doctest::Approx(4.0).epsilon(0.1));
    CHECK(observed_order<RungeKutta4>(1000, 0.5, truth) == doctest::Approx(4.0).epsilon(0.1));
    CHECK(observed_order<DormandPrince8>(40, 0.5, truth) == doctest::Approx(8.0).epsilon(0.15));
}

TEST_CASE("a free chain keeps its energy and momenta to 1e-11 over one second") {
    for (const int links : {1, 3, 6, 12, 24}) {
        Linkage linkage(shared::chain(links, BaseKind::floating));
        shared::Random random(31);
        linkage.data.position = haptics::testing::random_vector(random, linkage.model.freedoms, 1.0);
        linkage.data.velocity = haptics::testing::random_vector(random, linkage.model.freedoms, 1.0);
        update_kinematics(linkage.model, linkage.data);
        const double energy = kinetic_energy(linkage.model, linkage.data);
        const Momentum before = total_momentum(linkage.model, linkage.data);
        run<DormandPrince8>(linkage, 1000, 1e-3);
        const Momentum after = total_momentum(linkage.model, linkage.data);
        CAPTURE(links);
        CHECK(std::fabs(kinetic_energy(linkage.model, linkage.data) / energy - 1.0) < 1e-11);
        CHECK((after.linear - before.linear).norm() / before.linear.norm() < 1e-11);
        CHECK(std::fabs(after.angular / before.angular - 1.0) < 1e-10);
    }
}

TEST_CASE("without Coriolis a freely spinning arm swings far from its energy, with it the energy stays") {
    Linkage kept = moving_arm(true);
    Linkage dropped = moving_arm(false);
    for (Linkage* linkage : {&kept, &dropped}) {
        // half folded, so that there is room both ways
        linkage->data.position << 0.0, -1.9, 3.5;
        linkage->data.velocity << 4.0, -3.0, 6.0;
        update_kinematics(linkage->model, linkage->data);
    }
    const double energy = kinetic_energy(kept.model, kept.data);
    double lowest = 1.0;
    double highest = 1.0;
    double drift = 0.0;
    for (int i = 0; i < 1000; ++i) {
        run<RungeKutta4>(kept, 10, 1e-4);
        run<RungeKutta4>(dropped, 10, 1e-4);
        drift = std::max(drift, std::fabs(kinetic_energy(kept.model, kept.data) / energy - 1.0));
        const double ratio = kinetic_energy(dropped.model, dropped.data) / energy;
        lowest = std::min(lowest, ratio);
        highest = std::max(highest, ratio);
    }
    MESSAGE("energy with Coriolis drifts by " << drift << ", without it swings between " << lowest << " and "
                                              << highest << " times the initial one");
    CHECK(drift < 1e-7);
    CHECK(lowest < 0.6);
    CHECK(highest / lowest > 2.0);
}

TEST_CASE("external forces and gravity change the momentum of a free linkage by their impulse") {
    LinkageSpec spec = shared::chain(5, BaseKind::floating);
    spec.gravity = {0.4, -2.0};
    Linkage linkage(spec);
    linkage.data.position << 0.1, 0.2, 0.3, 0.4, -0.5, 0.6, -0.7;
    linkage.data.velocity << 0.0, 0.1, 1.0, -1.0, 2.0, 0.5, 0.3;
    update_kinematics(linkage.model, linkage.data);
    const Momentum before = total_momentum(linkage.model, linkage.data);
    LinkageVector force;
    force.setZero(linkage.model.freedoms);
    const Wrench wrench(0.7, -0.3, 0.02);
    const Vec2 at = link_point(linkage.model, linkage.data, 4, {0.1, 0.0});
    add_wrench(linkage.model, linkage.data, 4, at, wrench, force);
    // rate of momentum by central differences of a tiny step both ways
    LinkageVector acceleration;
    ArticulatedFactor factor;
    forward_dynamics(linkage.model, linkage.data, force, factor, acceleration);
    const LinkageVector q = linkage.data.position;
    const LinkageVector v = linkage.data.velocity;
    const auto momentum_at = [&](double h) {
        linkage.data.position = q + h * v + 0.5 * h * h * acceleration;
        linkage.data.velocity = v + h * acceleration;
        update_kinematics(linkage.model, linkage.data);
        return total_momentum(linkage.model, linkage.data);
    };
    const double h = 1e-4;
    const Momentum later = momentum_at(h);
    const Momentum earlier = momentum_at(-h);
    const double mass = 0.5;
    CHECK(((later.linear - earlier.linear) / (2.0 * h) - wrench.head<2>() - mass * spec.gravity).norm() <
          1e-6);
    // torque about the origin: of the wrench and of gravity at the center of mass
    linkage.data.position = q;
    linkage.data.velocity = v;
    update_kinematics(linkage.model, linkage.data);
    Vec2 center = Vec2::Zero();
    for (int link = 0; link < 5; ++link) {
        center += 0.2 * link_center_pose(linkage.model, linkage.data, link).head<2>();
    }
    const double torque = wrench.z() + cross(at, wrench.head<2>()) + mass * cross(center, spec.gravity);
    CHECK((later.angular - earlier.angular) / (2.0 * h) == doctest::Approx(torque).epsilon(1e-6));
    CHECK(before.linear.norm() > 0.0);
}
