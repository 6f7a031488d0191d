// Where the exact integrator does not apply, and what happens then.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/linkage_tools.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>

using namespace haptics;

namespace {

// equal within a share of the value
doctest::Approx within(double value, double share) {
    return doctest::Approx(value).epsilon(share).scale(0.0);
}

struct World {
    explicit World(const Model& m)
        : model(m) {
        model.settings.contact_mode = ContactMode::penalty;
    }
    Model model;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    std::unique_ptr<Neighborhood> scene{std::make_unique<Neighborhood>()};
    HandInput hand;
    StepOutput out;

    void begin(const Pose& pose) {
        scene->sequence = 1;
        reset(model, *data, pose);
        take_neighborhood(*scene, *data);
        hand.held = true;
    }
    void run(double h = 0.002) { step(model, *data, hand, h, out); }
};

// the same scene with the exact and with the linearly implicit integrator: one step, bit for bit the same
template <typename Build>
void check_gives_way(const Build& build) {
    std::unique_ptr<World> exact = build();
    std::unique_ptr<World> implicit = build();
    exact->model.settings.integrator = Integrator::exact;
    implicit->model.settings.integrator = Integrator::linearly_implicit;
    exact->run();
    implicit->run();
    CHECK(exact->out.exact_gave_way);
    CHECK(exact->out.fell_back);
    CHECK_FALSE(implicit->out.exact_gave_way);
    CHECK(exact->data->pose == implicit->data->pose);
    CHECK(exact->data->velocity == implicit->data->velocity);
    CHECK(exact->out.contact == implicit->out.contact);
    CHECK(exact->out.coupling == implicit->out.coupling);
}

} // namespace

TEST_SUITE_BEGIN("exact integrator");

TEST_CASE("exact: gives way to linearly implicit with more than 24 freedoms, and says so") {
    for (const int boxes : {7, 8}) {
        const auto build = [boxes] {
            auto w = std::make_unique<World>(shared::box_tool());
            // a row of boxes that all touch, the tool at its end
            for (int i = 0; i < boxes; ++i) {
                Body& b = w->scene->bodies.body[static_cast<std::size_t>(
                    shared::add_body(w->scene->bodies, static_cast<std::uint64_t>(10 + i), BodyKind::movable,
                                     shared::paper_surface(), Pose(0.0301 + 0.0201 * i, 0.0, 0.0)))];
                b.mass = 0.1;
                b.inertia = 1e-5;
                shared::add_piece(w->scene->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
            }
            w->begin(Pose::Zero());
            w->hand.force = Wrench(1.0, 0.0, 0.0);
            return w;
        };
        if (boxes == 8) {
            check_gives_way(build);
        } else {
            auto w = build();
            w->model.settings.integrator = Integrator::exact;
            w->run();
            CHECK(w->data->system.freedoms == 24);
            CHECK_FALSE(w->out.exact_gave_way);
        }
    }
}

TEST_CASE("exact: gives way with more than 32 contact points, and says so") {
    check_gives_way([] {
        Model model = shared::box_tool();
        model.tool.shape.piece[0].convex = make_box(Vec2::Zero(), Vec2(0.4, 0.02));
        auto w = std::make_unique<World>(model);
        for (int i = 0; i < 20; ++i) {
            Surface s = shared::paper_surface();
            s.stiffness += i; // another surface each: patches of their own
            shared::add_body(w->scene->bodies, static_cast<std::uint64_t>(10 + i), BodyKind::fixed, s,
                             Pose::Zero());
            shared::add_piece(w->scene->bodies, make_box(Vec2(-0.19 + 0.02 * i, -0.01), Vec2(0.018, 0.02)));
        }
        w->begin(Pose(0.0, 0.01 + 1e-5, 0.0));
        w->hand.force = Wrench(0.0, -2.0, 0.0);
        return w;
    });
}

TEST_CASE("exact: an overlap that no motion made does not throw the tool") {
    for (const double stiffness : {1e6, 1e9}) {
        Surface s = shared::paper_surface();
        s.stiffness = stiffness;
        World w(shared::box_tool());
        w.scene = shared::floor_of(1, s);
        w.model.settings.integrator = Integrator::exact;
        w.begin(Pose(0.0, 0.0095, 0.0)); // half a millimeter deep
        w.run();
        CHECK(w.out.exact_gave_way);
        double fastest = 0.0;
        for (int i = 0; i < 100; ++i) {
            fastest = std::max(fastest, w.data->velocity.y());
            w.run();
        }
        // the spring alone would give 0.91 m/s and 29 m/s
        CHECK(fastest <= 0.0005 / 0.002);
    }
}

TEST_CASE("exact: hundreds of oscillations in a step are left to linearly implicit, a slow mode is not") {
    const auto push = [](double stiffness, double damping) {
        Surface s;
        s.stiffness = stiffness;
        s.damping = damping;
        auto w = std::make_unique<World>(shared::box_tool());
        w->scene = shared::floor_of(1, s);
        w->model.settings.integrator = Integrator::exact;
        w->begin(Pose(0.0, 0.01 - 2.0 / stiffness, 0.0));
        w->hand.force = Wrench(0.0, -2.0, 0.0);
        w->run(); // it was put there
        int gave_way = 0;
        for (int i = 0; i < 500; ++i) {
            w->run();
            gave_way += w->out.exact_gave_way ? 1 : 0;
            CHECK(w->out.contact.y() == within(2.0, 0.01));
        }
        return gave_way;
    };
    CHECK(push(15000.0, 20.0) == 0);
    CHECK(push(1e8, 20.0) == 0);
    CHECK(push(1e12, 20.0) == 500);
    CHECK(push(1e6, 1e9) == 500);
}

TEST_CASE("exact: many patches at once are held with soft contacts, with hard ones it gives way") {
    const auto push = [](int patches, double stiffness) {
        World w(shared::box_tool());
        w.model.tool.shape.piece[0].convex = make_box(Vec2::Zero(), Vec2(0.2, 0.02));
        Surface s;
        s.stiffness = stiffness;
        s.damping = 20.0;
        s.static_friction = 0.6;
        s.dynamic_friction = 0.4;
        w.scene = shared::floor_of(patches, s);
        for (int i = 0; i < patches; ++i) // patches of their own
            w.scene->bodies.body[static_cast<std::size_t>(i)].surface.stiffness += i;
        w.model.settings.integrator = Integrator::exact;
        w.begin(Pose(0.0, 0.01 - 2.0 / (patches * stiffness), 0.0));
        w.hand.force = Wrench(0.3, -2.0, 0.0);
        w.run(); // it was put there
        int gave_way = 0;
        for (int i = 0; i < 200; ++i) {
            w.run();
            gave_way += w.out.exact_gave_way ? 1 : 0;
        }
        CHECK(w.data->patches.count == patches);
        CHECK(w.out.contact.y() == within(2.0, 0.01));
        CHECK(w.out.contact.x() == within(-0.3, 0.01));
        return gave_way;
    };
    for (const double stiffness : {1e3, 1e4, 1e5})
        CHECK(push(6, stiffness) == 0);
    CHECK(push(12, 1e6) == 200);
}

TEST_CASE("exact: every stiffness, damping, mass and step gives a finite motion") {
    for (const double stiffness : {0.0, 1.0, 1e6, 1e12})
        for (const double damping : {0.0, 20.0, 1e6, 1e12})
            for (const double mass : {1e-6, 0.1, 1e4})
                for (const double h : {1e-4, 1e-2}) {
                    CAPTURE(stiffness);
                    CAPTURE(damping);
                    CAPTURE(mass);
                    CAPTURE(h);
                    Surface s;
                    s.stiffness = stiffness;
                    s.damping = damping;
                    s.static_friction = 0.6;
                    s.dynamic_friction = 0.4;
                    World w(shared::box_tool(mass));
                    w.scene = shared::floor_of(3, s);
                    w.model.settings.integrator = Integrator::exact;
                    w.begin(Pose(0.0, 0.0105, 0.02));
                    w.data->velocity = Twist(0.1, -0.5, 3.0);
                    w.hand.stiffness = Vec3(1500.0, 1500.0, 2.0);
                    w.hand.damping = Vec3(10.0, 10.0, 0.01);
                    w.hand.target = Pose(0.0, 0.0, 0.0);
                    for (int i = 0; i < 20; ++i)
                        w.run(h);
                    CHECK(w.data->pose.allFinite());
                    CHECK(w.data->velocity.allFinite());
                    CHECK(w.out.contact.allFinite());
                    CHECK(w.out.coupling.allFinite());
                }
}

TEST_CASE("exact: a hit is resolved at the surface, not where a step happens to begin just above it") {
    Model model = shared::box_tool();
    model.settings.integrator = Integrator::exact;
    auto data = std::make_unique<Data>();
    constexpr double k_gap = 5e-7;
    reset(model, *data, Pose(0.0, 0.01 + k_gap, 0.0));
    data->velocity.y() = -0.2;
    take_neighborhood(*shared::floor_of(1), *data);
    StepOutput out;
    step(model, *data, HandInput{}, 1e-6, out);
    CHECK(out.collision_impulse.y() == 0.0);
    CHECK(data->pose.y() == within(0.01 + k_gap - 2e-7, 1e-12));
    step(model, *data, HandInput{}, 1e-5, out);
    CHECK(out.collision_impulse.y() == within(0.3 * 0.2, 1e-9));
    CHECK(std::abs(data->pose.y() - 0.01) < 1e-12);
}

TEST_CASE("exact: a bounce that begins and ends within a step is told as one touch") {
    Surface s;
    s.stiffness = 1e8;
    s.damping = 0.0;
    World w(shared::box_tool());
    w.scene = shared::floor_of(1, s);
    w.model.settings.integrator = Integrator::exact;
    w.begin(Pose(0.0, 0.01 + 0.0001, 0.0));
    w.hand.held = false;
    w.data->velocity = Twist(0.0, -0.2, 0.0);
    w.run();
    CHECK(w.data->velocity.y() == within(0.2, 1e-9));
    CHECK(w.out.contact.y() == within(0.3 * 0.4 / 0.002, 1e-9));
    CHECK(w.out.sliding == 1);
    REQUIRE(w.out.event_count == 1);
    CHECK(w.out.event[0].kind == ContactEventKind::began);
    CHECK(w.data->patches.patch[0].memory.normal_force == within(0.3 * 0.4 / 0.002, 1e-9));
    w.run();
    CHECK(w.out.contacts == 0);
    REQUIRE(w.out.event_count == 1);
    CHECK(w.out.event[0].kind == ContactEventKind::ended);
}

TEST_CASE("exact: with impulses a hit comes at its true time, also when the hand accelerates towards it") {
    for (const double e : {0.0, 0.5, 1.0})
        for (int phase = 0; phase < 8; ++phase) {
            Surface s = shared::paper_surface();
            s.stiffness = 1e7;
            s.restitution = e;
            World w(shared::box_tool());
            w.model.settings.contact_mode = ContactMode::penalty_impulse;
            w.model.settings.integrator = Integrator::exact;
            w.scene = shared::floor_of(1, s);
            const double height = 0.0004 + 0.0004 * phase / 8.0;
            w.begin(Pose(0.0, 0.01 + height, 0.0));
            w.data->velocity = Twist(0.0, -0.1, 0.0);
            w.hand.force = Wrench(0.0, -15.0, 0.0); // 50 m/s^2
            const double speed = std::sqrt(0.01 + 2.0 * 50.0 * height);
            bool hit = false;
            for (int i = 0; i < 4 && !hit; ++i) {
                w.run();
                hit = w.out.colliding > 0;
            }
            CAPTURE(e);
            CAPTURE(phase);
            REQUIRE(hit);
            CHECK(w.out.collision_impulse.y() == within(0.3 * speed * (1.0 + e), 1e-6));
        }
}

TEST_CASE(
    "exact: a door swings into a lossless stop and comes back as fast, a sprung drawer keeps its period") {
    LinkageSpec spec = shared::door();
    JointSpec& hinge = spec.links[0].joint;
    hinge.upper_limit = 0.3;
    hinge.lower_limit = -0.3;
    hinge.limit_stiffness = 1e5;
    World w(shared::linkage_tool(spec));
    w.model.settings.integrator = Integrator::exact;
    LinkageVector start(1);
    start << 0.0;
    w.scene->sequence = 1;
    reset(w.model, *w.data, start);
    take_neighborhood(*w.scene, *w.data);
    w.data->linkage.velocity[0] = 2.0;
    for (int i = 0; i < 2000; ++i) {
        w.run();
        CHECK_FALSE(w.out.exact_gave_way);
    }
    // one rod about its end: m l^2 / 3; flights of 0.6 rad and stops of half a period
    const double inertia = 0.3 * 0.04 / 3.0;
    const double stop = std::numbers::pi * std::sqrt(inertia / 1e5);
    const double flight = 0.6 / 2.0;
    const double phase = std::fmod(4.0 - 0.15, flight + stop);
    const double turns = std::floor((4.0 - 0.15) / (flight + stop));
    REQUIRE(phase > stop);
    const double sign = std::fmod(turns, 2.0) < 1.0 ? -1.0 : 1.0;
    CHECK(w.data->linkage.velocity[0] == within(2.0 * sign, 1e-9));
    CHECK(w.data->linkage.position[0] == within(-sign * (0.3 - 2.0 * (phase - stop)), 1e-6));

    spec = shared::drawer();
    spec.links[0].joint.spring_stiffness = 40.0;
    World d(shared::linkage_tool(spec));
    d.model.settings.integrator = Integrator::exact;
    d.scene->sequence = 1;
    start << 0.02;
    reset(d.model, *d.data, start);
    take_neighborhood(*d.scene, *d.data);
    for (int i = 0; i < 2000; ++i)
        d.run();
    const double rate = std::sqrt(40.0 / 0.3);
    CHECK(d.data->linkage.position[0] == within(0.02 * std::cos(4.0 * rate), 1e-9));
    CHECK(d.data->linkage.velocity[0] == within(-0.02 * rate * std::sin(4.0 * rate), 1e-9));
}

TEST_SUITE_END();
