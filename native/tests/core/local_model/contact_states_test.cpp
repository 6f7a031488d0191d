#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

using namespace haptics;

namespace {

// a box above the floor with everything at hand
struct Scene {
    explicit Scene(const Surface& surface, double height = 0.001, const Vec2& velocity = Vec2::Zero())
        : model(shared::box_tool())
        , data(std::make_unique<Data>()) {
        reset(model, *data, Pose(0.0, 0.01 + height, 0.0));
        data->velocity.head<2>() = velocity;
        take_neighborhood(*shared::floor_of(1, surface), *data);
        hand.held = true;
    }
    void push(double x, double y) { hand.force = Wrench(x, y, 0.0); }
    // grows the push evenly, so that the friction spring does not ring
    ContactState ramp(double x, double y, int steps) {
        const Wrench from = hand.force;
        for (int i = 1; i <= steps; ++i) {
            const double part = static_cast<double>(i) / steps;
            hand.force = (1.0 - part) * from + part * Wrench(x, y, 0.0);
            run();
        }
        return run();
    }
    ContactState run(int steps = 1) {
        for (int i = 0; i < steps; ++i)
            step(model, *data, hand, h, out);
        return data->patches.count == 0 ? ContactState::none : data->patches.patch[0].memory.state;
    }

    Model model;
    std::unique_ptr<Data> data;
    HandInput hand;
    StepOutput out;
    double h{0.001};
};

Surface rough(double mu_static, double mu_dynamic) {
    Surface s = shared::paper_surface();
    s.static_friction = mu_static;
    s.dynamic_friction = mu_dynamic;
    return s;
}

} // namespace

TEST_CASE("a slow approach goes from none to continuous contact without a collision") {
    Scene s(shared::paper_surface(), 1e-6, Vec2(0.0, -0.004));
    s.push(0.0, -0.5);
    int collisions = 0;
    for (int i = 0; i < 200; ++i) {
        s.run();
        collisions += s.out.colliding;
    }
    CHECK(collisions == 0);
    CHECK(s.run() == ContactState::sliding); // frictionless
}

TEST_CASE("a fast approach collides for exactly one step, then stays in contact, and opens into none") {
    Scene s(shared::paper_surface(), 0.001, Vec2(0.0, -0.1));
    s.push(0.0, -2.0);
    int colliding = 0;
    ContactState after = ContactState::none;
    for (int i = 0; i < 100; ++i) {
        const ContactState state = s.run();
        if (state == ContactState::colliding) {
            ++colliding;
            after = s.run();
        }
    }
    CHECK(colliding == 1);
    CHECK(after == ContactState::sliding);
    s.push(0.0, 2.0);
    bool opened = false;
    for (int i = 0; i < 100 && !opened; ++i)
        opened = s.run() == ContactState::none;
    CHECK(opened);
}

TEST_CASE("with penalty alone nothing collides") {
    Scene s(shared::paper_surface(), 0.001, Vec2(0.0, -0.5));
    s.model.settings.contact_mode = ContactMode::penalty;
    int colliding = 0;
    int touching = 0;
    for (int i = 0; i < 50; ++i) {
        s.run();
        colliding += s.out.colliding;
        touching += s.out.contacts;
    }
    CHECK(colliding == 0);
    CHECK(touching > 0);
}

TEST_CASE("sticking turns into sliding above the static bound and back below the dynamic one") {
    Scene s(rough(0.5, 0.3));
    reset(s.model, *s.data, Pose(0.0, 0.0099, 0.0));
    s.push(0.0, -2.0);
    CHECK(s.run(500) == ContactState::sticking);
    CHECK(s.ramp(0.98, -2.0, 2000) == ContactState::sticking);
    CHECK(s.ramp(1.02, -2.0, 200) == ContactState::sliding);
    CHECK(s.out.contact.x() == doctest::Approx(-0.6).epsilon(0.01));
    s.push(0.0, -2.0);
    CHECK(s.run(400) == ContactState::sticking);
    CHECK(s.data->velocity.head<2>().norm() < 1e-6);
}

TEST_CASE("a sticking contact does not creep in 10 minutes at 99 % of the static bound") {
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
        for (const ContactMode mode : {ContactMode::penalty_impulse, ContactMode::penalty}) {
            Scene s(rough(0.5, 0.4));
            s.model.settings.integrator = integrator;
            s.model.settings.contact_mode = mode;
            s.h = 0.002;
            reset(s.model, *s.data, Pose(0.0, 0.0099, 0.0));
            s.push(0.0, -2.0);
            s.run(1000);
            s.ramp(0.99, -2.0, 2000);
            s.run(2000);
            const double start = s.data->pose.x();
            s.run(300000);
            CAPTURE(static_cast<int>(integrator));
            CAPTURE(static_cast<int>(mode));
            CHECK(std::abs(s.data->pose.x() - start) < 1e-12);
            CHECK(s.out.sticking == 1);
            CHECK_FALSE(s.out.fell_back);
        }
}

TEST_CASE("a single hit returns e times its speed wherever in the step it falls") {
    for (const double e : {0.0, 0.3, 0.8, 1.0})
        for (int phase = 0; phase < 16; ++phase) {
            Surface surface = shared::paper_surface();
            surface.restitution = e;
            Scene s(surface, 0.0005 + 0.0002 * phase / 16.0, Vec2(0.0, -0.2));
            s.hand.held = false;
            s.run(6);
            CAPTURE(e);
            CAPTURE(phase);
            CHECK(s.data->velocity.y() == doctest::Approx(0.2 * e).epsilon(0.02));
        }
}

TEST_CASE("an event tells of the first touch, the impact, the slip and the end") {
    Scene s(rough(0.5, 0.3), 0.001, Vec2(0.0, -0.1));
    const Vec3 velocity = s.data->velocity;
    reset(s.model, *s.data, Pose(0.0, 0.011, 0.0));
    s.data->velocity = velocity;
    std::array<int, 4> count{};
    const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            s.run();
            for (int k = 0; k < s.out.event_count; ++k) {
                const ContactEvent& event = s.out.event[static_cast<std::size_t>(k)];
                CHECK(event.body == 100);
                ++count[static_cast<std::size_t>(event.kind)];
                if (event.kind == ContactEventKind::impact)
                    CHECK(event.impulse == doctest::Approx(0.3 * 0.1).epsilon(0.05));
            }
        }
    };
    s.push(0.0, -2.0);
    run(500);
    s.push(2.0, -2.0);
    run(20);
    s.push(0.0, 2.0);
    run(100);
    CHECK(count == std::array<int, 4>{1, 1, 1, 1});
}
