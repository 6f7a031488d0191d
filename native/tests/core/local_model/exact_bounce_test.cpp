// A mass that falls onto a spring-damper, against the closed form.
//
// While it presses, m g'' = -K g - B g', g(0) = 0, g'(0) = -v. With w = sqrt(K/m), z = B / (2 sqrt(K m)) < 1,
// w_d = w sqrt(1 - z^2):
//     g = -(v / w_d) exp(-z w t) sin(w_d t).
// It leaves when the force, hence g'', is zero: w_d T = pi - atan(2 z sqrt(1 - z^2) / (1 - 2 z^2)).

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "support/allocation_guard.hpp"

using namespace haptics;

namespace {

// equal within a share of the value
doctest::Approx within_share(double value, double share) {
    return doctest::Approx(value).epsilon(share).scale(0.0);
}

constexpr double k_speed = 0.2;

struct Exit {
    double time;
    double gap;
    double rate;
};

Exit closed_form(double mass, double stiffness, double damping) {
    const double w = std::sqrt(stiffness / mass);
    const double z = damping / (2.0 * std::sqrt(stiffness * mass));
    const double root = std::sqrt(1.0 - z * z);
    const double wd = w * root;
    const double angle = std::numbers::pi - std::atan2(2.0 * z * root, 1.0 - 2.0 * z * z);
    const double t = angle / wd;
    const double fade = k_speed / wd * std::exp(-z * w * t);
    return {t, -fade * std::sin(angle), -fade * (wd * std::cos(angle) - z * w * std::sin(angle))};
}

enum class Shape { disc, edge, corner };

struct Drop {
    Drop(Shape shape, double mass, double stiffness, double damping, double height, double spin = 0.0)
        : model(shared::box_tool(mass))
        , data(std::make_unique<Data>()) {
        model.settings.integrator = Integrator::exact;
        model.settings.contact_mode = ContactMode::penalty;
        if (shape == Shape::disc)
            model.tool.shape.piece[0].convex = make_disc(Vec2::Zero(), 0.01);
        const double angle = shape == Shape::corner ? 0.5 : 0.0;
        rest_height = shape == Shape::disc ? 0.01 : 0.02 * std::sin(angle) + 0.01 * std::cos(angle);
        start = rest_height + height;
        reset(model, *data, Pose(0.0, start, angle));
        data->velocity = Twist(0.0, -k_speed, spin);
        Surface s = shared::paper_surface();
        s.stiffness = stiffness;
        s.damping = damping;
        take_neighborhood(*shared::floor_of(1, s), *data);
    }

    // until it has touched and flies again; the number of steps
    int run(double rate, const HandInput& hand = {}) {
        bool touched = false;
        for (int i = 1; i <= 20000; ++i) {
            step(model, *data, hand, 1.0 / rate, out);
            gave_way = gave_way || out.exact_gave_way;
            peak = std::max(peak, out.contact.y());
            impulse += out.contact.y() / rate;
            touched = touched || out.contact.y() != 0.0;
            if (touched && out.contact.y() == 0.0)
                return i;
        }
        return -1;
    }
    [[nodiscard]] double energy() const {
        return 0.5 * model.tool.mass * data->velocity.head<2>().squaredNorm() +
               0.5 * model.tool.inertia * data->velocity.z() * data->velocity.z();
    }

    Model model;
    std::unique_ptr<Data> data;
    StepOutput out;
    double rest_height{0.0};
    double start{0.0};
    double impulse{0.0};
    double peak{0.0};
    bool gave_way{false};
};

} // namespace

TEST_SUITE_BEGIN("exact integrator");

TEST_CASE(
    "exact: a lossless bounce of a disc and of an edge is the closed form, wherever in the step it falls") {
    double worst_energy = 0.0;
    double worst_time = 0.0;
    for (const Shape shape : {Shape::disc, Shape::edge})
        for (const double mass : {0.1, 0.3, 1.0})
            for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e10, 1e12})
                for (const double rate : {250.0, 500.0, 1000.0, 4000.0})
                    for (int phase = 0; phase < 8; ++phase) {
                        CAPTURE(mass);
                        CAPTURE(stiffness);
                        CAPTURE(rate);
                        CAPTURE(phase);
                        const double height = 0.0005 + k_speed / rate * phase / 8.0;
                        Drop d(shape, mass, stiffness, 0.0, height);
                        const int steps = d.run(rate);
                        REQUIRE(steps > 0);
                        CHECK_FALSE(d.gave_way);
                        CHECK(d.impulse == within_share(2.0 * mass * k_speed, 1e-10));
                        worst_energy = std::max(
                            worst_energy, std::abs(d.energy() / (0.5 * mass * k_speed * k_speed) - 1.0));
                        // time in contact = all time - falling - rising
                        const double fall = height / k_speed;
                        const double rise = (d.data->pose.y() - d.rest_height) / k_speed;
                        const double contact = steps / rate - fall - rise;
                        const double expected = std::numbers::pi * std::sqrt(mass / stiffness);
                        worst_time = std::max(worst_time, std::abs(contact - expected));
                    }
    MESSAGE("largest error: energy " << worst_energy << ", time in contact " << worst_time << " s");
    CHECK(worst_energy < 1e-10);
    CHECK(worst_time < 1e-12);
}

TEST_CASE("exact: a damped bounce leaves when the closed form does, as fast") {
    double worst_speed = 0.0;
    double worst_time = 0.0;
    for (const double mass : {0.1, 0.3, 1.0})
        for (const double stiffness : {1e3, 1.5e4, 1e6, 1e8})
            for (const double ratio : {0.05, 0.3, 0.6, 0.9})
                for (const double rate : {250.0, 1000.0, 4000.0})
                    for (int phase = 0; phase < 8; ++phase) {
                        const double damping = 2.0 * ratio * std::sqrt(stiffness * mass);
                        CAPTURE(mass);
                        CAPTURE(stiffness);
                        CAPTURE(ratio);
                        CAPTURE(rate);
                        CAPTURE(phase);
                        const double height = 0.0005 + k_speed / rate * phase / 8.0;
                        Drop d(Shape::edge, mass, stiffness, damping, height);
                        const int steps = d.run(rate);
                        REQUIRE(steps > 0);
                        CHECK_FALSE(d.gave_way);
                        const Exit exit = closed_form(mass, stiffness, damping);
                        worst_speed =
                            std::max(worst_speed, std::abs(d.data->velocity.y() - exit.rate) / k_speed);
                        const double flown = steps / rate - height / k_speed - exit.time;
                        const double expected = exit.gap + exit.rate * flown;
                        worst_time = std::max(
                            worst_time, std::abs(d.data->pose.y() - d.rest_height - expected) / k_speed);
                    }
    MESSAGE("largest error: speed " << worst_speed << " of the approach, time " << worst_time << " s");
    CHECK(worst_speed < 1e-10);
    CHECK(worst_time < 1e-12);
}

TEST_CASE("exact: a disc, an edge and a spinning corner keep their energy from soft to hard at 500 Hz") {
    double worst = 0.0;
    const auto drop = [&](Shape shape, double mass, double stiffness, double spin, int phase) {
        CAPTURE(static_cast<int>(shape));
        CAPTURE(mass);
        CAPTURE(stiffness);
        CAPTURE(spin);
        CAPTURE(phase);
        Drop d(shape, mass, stiffness, 0.0, 0.0005 + 0.0004 * phase / 8.0, spin);
        const double before = d.energy();
        REQUIRE(d.run(500.0) > 0);
        CHECK_FALSE(d.gave_way);
        const double error = std::abs(d.energy() / before - 1.0);
        CHECK(error < 1e-4);
        worst = std::max(worst, error);
    };
    for (const double mass : {0.1, 0.3, 1.0})
        for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
            for (int phase = 0; phase < 8; ++phase) {
                drop(Shape::edge, mass, stiffness, 0.0, phase);
                for (const double spin : {-5.0, 0.0, 10.0}) {
                    drop(Shape::disc, mass, stiffness, spin, phase);
                    // (a soft contact lasts long enough for -5 rad/s to turn the corner into an edge)
                    if (spin >= 0.0 || stiffness > 1e4)
                        drop(Shape::corner, mass, stiffness, spin, phase);
                }
            }
    MESSAGE("largest energy error " << worst);
}

// The ends of an edge share the patch's stiffness by their heights, and that law has no potential: around a
// loop it gives or takes energy, whoever integrates it. It must stay an error of that size.
TEST_CASE("exact: an edge that tilts while it presses gains or loses what the law of shares gives or takes") {
    double least = 1e300;
    double most = 0.0;
    for (const double mass : {0.1, 1.0})
        for (const double stiffness : {1e4, 1e6, 1e8})
            for (const double spin : {1.0, 3.0, 10.0})
                for (int phase = 0; phase < 8; ++phase) {
                    Drop d(Shape::edge, mass, stiffness, 0.0, 0.0005 + 0.0004 * phase / 8.0, spin);
                    const double before = d.energy();
                    REQUIRE(d.run(500.0) > 0);
                    least = std::min(least, d.energy() / before);
                    most = std::max(most, d.energy() / before);
                }
    MESSAGE("a tilting edge returns " << least << " to " << most << " of its energy");
    CHECK(least > 0.5);
    CHECK(most < 1.6);
}

TEST_CASE("exact: a mass that a lossless spring pulls onto a hard wall bounces for ever") {
    for (const double stiffness : {1e5, 1e8}) {
        Drop d(Shape::disc, 0.2, stiffness, 0.0, 0.002);
        HandInput hand;
        hand.held = true;
        hand.stiffness = Vec3(1500.0, 1500.0, 0.0);
        hand.target = Pose(0.0, 0.009, 0.0);
        const auto energy = [&] {
            const double stretch = d.data->pose.y() - 0.009;
            return d.energy() + 750.0 * stretch * stretch;
        };
        const double before = energy();
        double worst = 0.0;
        int flying = 0;
        for (int i = 0; i < 500; ++i) {
            step(d.model, *d.data, hand, 0.002, d.out);
            CHECK_FALSE(d.out.exact_gave_way);
            if (d.data->pose.y() <= 0.01)
                continue;
            ++flying;
            worst = std::max(worst, std::abs(energy() / before - 1.0));
        }
        MESSAGE(stiffness << " N/m: largest energy error in 1 s " << worst);
        CHECK(flying > 300);
        CHECK(worst < 1e-9);
    }
}

TEST_CASE("exact: a coupling adds its mean force, and its limit holds") {
    // no contact: a mass on the coupling alone, x'' = -k x / m
    Drop d(Shape::disc, 0.2, 1e4, 0.0, 0.5);
    HandInput hand;
    hand.held = true;
    hand.stiffness = Vec3(300.0, 300.0, 0.0);
    hand.target = d.data->pose + Pose(0.01, 0.0, 0.0);
    d.data->velocity.setZero();
    step(d.model, *d.data, hand, 0.002, d.out);
    const double w = std::sqrt(300.0 / 0.2);
    CHECK(d.data->pose.x() == within_share(0.01 * (1.0 - std::cos(0.002 * w)), 1e-12));
    CHECK(d.data->velocity.x() == within_share(0.01 * w * std::sin(0.002 * w), 1e-12));
    CHECK(d.out.coupling.x() == within_share(0.2 * d.data->velocity.x() / 0.002, 1e-12));

    Drop held(Shape::disc, 0.2, 1e4, 0.0, 0.5);
    held.data->velocity.setZero();
    hand.target = held.data->pose + Pose(0.01, 0.0, 0.0);
    hand.max_force = 1.0;
    step(held.model, *held.data, hand, 0.002, held.out);
    CHECK(held.out.coupling.x() == within_share(1.0, 1e-9));
    CHECK(held.out.full_coupling.x() > 2.5);
    CHECK(held.data->velocity.x() == within_share(0.002 / 0.2, 1e-9));
}

TEST_CASE(
    "exact: an object is hit as by the law of elastic collisions, the tool's counter tells the impulse") {
    for (const double ratio : {1e-3, 0.1, 1.0, 1e3})
        for (const double stiffness : {1e4, 1e8})
            for (int phase = 0; phase < 8; ++phase) {
                CAPTURE(ratio);
                CAPTURE(stiffness);
                CAPTURE(phase);
                Drop d(Shape::disc, 0.3, stiffness, 0.0, 0.0);
                reset(d.model, *d.data, Pose::Zero());
                d.data->velocity = Twist(k_speed, 0.0, 0.0);
                Neighborhood n;
                n.sequence = 2;
                Surface s = shared::paper_surface();
                s.stiffness = stiffness;
                s.damping = 0.0;
                Body& b = n.bodies.body[static_cast<std::size_t>(shared::add_body(
                    n.bodies, 7, BodyKind::movable, s, Pose(0.0203 + 0.0004 * phase / 8.0, 0.0, 0.0)))];
                b.mass = 0.3 * ratio;
                b.inertia = b.mass * 2e-4;
                shared::add_piece(n.bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
                take_neighborhood(n, *d.data);
                double work = 0.0;
                for (int i = 0; i < 200; ++i) {
                    step(d.model, *d.data, HandInput{}, 0.002, d.out);
                    CHECK_FALSE(d.out.exact_gave_way);
                    work += d.out.source_work;
                }
                const MovableBelief& object = d.data->movable[0].belief;
                CHECK(d.data->velocity.x() ==
                      doctest::Approx(k_speed * (1.0 - ratio) / (1.0 + ratio)).epsilon(1e-9).scale(k_speed));
                CHECK(object.velocity.x() == within_share(k_speed * 2.0 / (1.0 + ratio), 1e-9));
                CHECK(object.given.x() == within_share(b.mass * object.velocity.x(), 1e-9));
                // the object took its energy from the tool
                CHECK(work == within_share(-0.5 * b.mass * object.velocity.x() * object.velocity.x(), 1e-9));
            }
}

TEST_CASE("exact: neither allocates nor differs from run to run") {
    const auto run = [](std::uint64_t& allocations) {
        Drop d(Shape::corner, 0.2, 1e6, 3.0, 0.0007, 4.0);
        HandInput hand;
        hand.held = true;
        hand.stiffness = Vec3(800.0, 800.0, 1.0);
        hand.damping = Vec3(4.0, 4.0, 0.004);
        hand.target = Pose(0.001, 0.01, 0.4);
        const testing::AllocationGuard guard;
        for (int i = 0; i < 300; ++i)
            step(d.model, *d.data, hand, 0.001, d.out);
        allocations = guard.allocations();
        return std::pair{d.data->pose, d.out.coupling};
    };
    std::uint64_t allocations = 0;
    const auto first = run(allocations);
    CHECK(allocations == 0);
    const auto second = run(allocations);
    CHECK(first.first == second.first);
    CHECK(first.second == second.second);
}

TEST_SUITE_END();
