#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>
#include <haptics/sweep/reference_disc.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>

#include "support/random.hpp"

using namespace haptics;
using sweep::ReferenceDisc;
using sweep::ReferenceWall;

namespace {

constexpr double k_radius = 0.01;

struct BesideReference {
    Model model;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    HandInput hand;
    ReferenceDisc reference;
};

template <typename Random>
BesideReference draw(Random& random, double hardest) {
    BesideReference p;
    const auto between = [&](double low, double high) { return random.uniform(low, high); };
    const auto decade = [&](double low, double high) {
        return std::pow(10.0, random.uniform(std::log10(low), std::log10(high)));
    };
    const double mass = decade(0.05, 1.0);
    p.model = shared::box_tool(mass);
    p.model.settings.integrator = Integrator::exact;
    p.model.settings.contact_mode = ContactMode::penalty;
    p.model.tool.shape.piece[0].convex = make_disc(Vec2::Zero(), k_radius);
    p.model.tool.inertia = 1e12;

    ReferenceDisc& r = p.reference;
    r.mass = mass;
    r.radius = k_radius;
    r.gravity = {between(-5.0, 5.0), between(-10.0, 0.0)};
    Neighborhood scene;
    scene.sequence = 1;
    scene.gravity = r.gravity;
    const int count = 2 + static_cast<int>(between(0.0, 2.99));
    const double turn = between(0.0, 2.0 * std::numbers::pi);
    for (int i = 0; i < count; ++i) {
        const double angle = turn + 2.0 * std::numbers::pi * i / count + between(-0.3, 0.3);
        Surface s;
        s.stiffness = decade(1e3, hardest);
        s.damping = between(0.0, 1.0) < 0.3 ? 0.0 : between(0.0, 1.2) * std::sqrt(s.stiffness * mass);
        s.dynamic_friction = between(0.0, 1.0) < 0.3 ? 0.0 : between(0.05, 0.8);
        s.static_friction = s.dynamic_friction * (between(0.0, 1.0) < 0.3 ? 1.0 : between(1.0, 1.8));
        const Vec2 normal = rotate(angle, Vec2(0.0, 1.0));
        const Vec2 point = -(k_radius + between(0.0, 0.002)) * normal;
        r.walls.push_back({point, normal, s.stiffness, s.damping, s.static_friction, s.dynamic_friction});
        shared::add_body(scene.bodies, static_cast<std::uint64_t>(10 + i), BodyKind::fixed, s,
                         Pose(point.x(), point.y(), angle));
        shared::add_piece(scene.bodies, make_half_plane(Vec2::Zero(), Vec2(0.0, 1.0)));
    }
    const Pose start(0.0, 0.0, between(-3.0, 3.0));
    reset(p.model, *p.data, start);
    p.data->velocity = Twist(between(-0.3, 0.3), between(-0.3, 0.3), 0.0);
    take_neighborhood(scene, *p.data);
    r.pose = start;
    r.velocity = p.data->velocity;
    if (between(0.0, 1.0) < 0.7) {
        p.hand.held = true;
        const double k = decade(50.0, 3000.0);
        p.hand.stiffness = Vec3(k, 1.3 * k, 0.0);
        p.hand.damping = between(0.1, 1.0) * std::sqrt(k * mass) * Vec3(1.0, 0.7, 0.0);
        p.hand.target_velocity = Twist(between(-0.1, 0.1), between(-0.1, 0.1), 0.0);
        p.hand.target = start + Pose(between(-2e-3, 2e-3), between(-2e-3, 2e-3), 0.0);
        r.spring = p.hand.stiffness;
        r.damper = p.hand.damping;
        r.target = p.hand.target;
        r.target_velocity = p.hand.target_velocity;
    }
    return p;
}

} // namespace

TEST_SUITE_BEGIN("exact integrator");

TEST_CASE("exact: a disc among walls moves as in tiny steps of Runge and Kutta, friction and hand included") {
    testing::Random random(7);
    double worst = 0.0;
    double worst_force = 0.0;
    int events = 0;
    int compared = 0;
    for (int draw_index = 0; draw_index < 200; ++draw_index) {
        BesideReference p = draw(random, 1e6);
        const double h = draw_index % 2 == 0 ? 0.001 : 0.002;
        CAPTURE(draw_index);
        // the fastest that a wall's spring can move the disc, normal and friction springs together
        double fastest = 100.0;
        for (const ReferenceWall& w : p.reference.walls)
            fastest = std::max({fastest, std::sqrt(4.0 * w.stiffness / p.reference.mass),
                                4.0 * w.damping / p.reference.mass});
        const double fine = 1.5e-3 / fastest;
        StepOutput out;
        for (int i = 0; i < 16; ++i) {
            ReferenceDisc& r = p.reference;
            p.hand.target = r.target + h * r.target_velocity;
            step(p.model, *p.data, p.hand, h, out);
            r.clear();
            r.advance(h, fine);
            if (r.tie)
                break;
            REQUIRE_FALSE(out.exact_gave_way);
            // in mm, and in 0.3 m/s
            worst = std::max(worst, (p.data->pose - r.pose).head<2>().norm() / 1e-3);
            worst = std::max(worst, (p.data->velocity - r.velocity).head<2>().norm() / 0.3);
            Vec2 contact{0.0, 0.0};
            for (const ReferenceWall& w : r.walls)
                contact += w.impulse.x() * w.normal + w.impulse.y() * perpendicular(w.normal);
            const double force = std::max(1.0, contact.norm() / h);
            worst_force = std::max(worst_force, (out.contact.head<2>() - contact / h).norm() / force);
            worst_force = std::max(worst_force, (out.coupling - r.coupling_impulse / h).head<2>().norm() /
                                                    std::max(1.0, force));
            ++compared;
        }
        events += p.reference.events;
    }
    MESSAGE(compared << " steps, " << events << " events; largest error: motion " << worst << ", force "
                     << worst_force);
    CHECK(events > 500);
    CHECK(worst < 1e-9);
    CHECK(worst_force < 1e-9);
}

namespace {

// A box held at a corner of its edge falls turning onto a rough floor and pushes a lighter box along it.
Pose tumble(Integrator integrator, double rate) {
    Model model = shared::box_tool(0.2);
    model.settings.integrator = integrator;
    model.settings.contact_mode = ContactMode::penalty;
    model.tool.grip.point = Vec2(0.015, 0.008);
    auto data = std::make_unique<Data>();
    reset(model, *data, Pose(0.0, 0.022, 0.35));
    data->velocity = Twist(0.3, -0.25, -6.0);
    Surface s;
    s.stiffness = 8e4;
    s.damping = 12.0;
    s.static_friction = 0.5;
    s.dynamic_friction = 0.35;
    auto scene = shared::floor_of(1, s);
    scene->gravity = Vec2(0.0, -9.81);
    const auto other = static_cast<std::size_t>(
        shared::add_body(scene->bodies, 9, BodyKind::movable, s, Pose(0.037, 0.0101, 0.0)));
    scene->bodies.body[other].mass = 0.08;
    scene->bodies.body[other].inertia = 0.08 * 6e-5;
    shared::add_piece(scene->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    take_neighborhood(*scene, *data);
    HandInput hand;
    hand.held = true;
    hand.stiffness = Vec3(600.0, 600.0, 0.3);
    hand.damping = Vec3(3.0, 3.0, 0.002);
    hand.target_velocity = Twist(0.1, 0.0, 0.0);
    const Pose target = grip_pose(data->grip, data->pose) + Pose(0.002, -0.004, 0.0);
    StepOutput out;
    const int steps = static_cast<int>(std::lround(0.03 * rate));
    for (int i = 1; i <= steps; ++i) {
        hand.target = target + i / rate * hand.target_velocity;
        step(model, *data, hand, 1.0 / rate, out);
    }
    return data->pose;
}

} // namespace

TEST_CASE("exact: a tumbling, rubbing, pushing box goes where ever smaller linearly implicit steps lead") {
    // linearly implicit is of first order: two small steps give the limit
    const Pose truth =
        2.0 * tumble(Integrator::linearly_implicit, 400e3) - tumble(Integrator::linearly_implicit, 200e3);
    const auto error = [&](Integrator integrator, double rate) {
        const Pose off = tumble(integrator, rate) - truth;
        return std::max(off.head<2>().norm(), 0.02 * std::abs(off.z()));
    };
    std::ostringstream table;
    for (const double rate : {500.0, 1000.0, 2000.0, 4000.0})
        table << "\n    " << rate << " Hz: exact " << error(Integrator::exact, rate)
              << " m, linearly implicit " << error(Integrator::linearly_implicit, rate) << " m";
    MESSAGE("error after 30 ms and 9 mm" << table.str());
    CHECK(error(Integrator::exact, 500.0) < 5e-5);
    CHECK(error(Integrator::exact, 4000.0) < 2e-6);
    CHECK(error(Integrator::linearly_implicit, 500.0) > 10.0 * error(Integrator::exact, 500.0));
}

TEST_SUITE_END();
