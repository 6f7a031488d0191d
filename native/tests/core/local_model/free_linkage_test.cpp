// A linkage beside the tool: what the tool's step foresees of it, and what the two do together.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/local_model/free_linkage.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace haptics;

namespace {

constexpr double k_free_step = 0.001;
constexpr std::uint64_t k_number = 5;

LinkageVector joints_at(std::initializer_list<double> values) {
    LinkageVector v(static_cast<Eigen::Index>(values.size()));
    std::copy(values.begin(), values.end(), v.data());
    return v;
}

// a linkage that runs beside a tool, whose neighbors its links are
struct Beside {
    Beside(const Model& tool_model, const Pose& start, const LinkageSpec& spec, const LinkageVector& at,
           const Surface& surface, double dt = k_free_step)
        : step_time(dt)
        , tool(tool_model)
        , linkage(shared::linkage_tool(spec))
        , data(std::make_unique<Data>())
        , links(std::make_unique<Data>()) {
        reset(tool, *data, start);
        reset(linkage, *links, at);
        auto n = std::make_unique<Neighborhood>();
        n->sequence = 1;
        for (int i = 0; i < linkage.tool.linkage.link_count; ++i) {
            const Body& from = links->tool.body[static_cast<std::size_t>(i)];
            Body& b = n->bodies.body[static_cast<std::size_t>(shared::add_body(
                n->bodies, static_cast<std::uint64_t>(i + 1), BodyKind::movable, surface, from.pose))];
            b.mass = linkage.tool.linkage.link[i].mass;
            b.inertia = linkage.tool.linkage.link[i].inertia;
            b.jointed = true;
            b.linkage = k_number;
            b.link = i;
            b.mobility = Mat3::Identity();
            shared::add_piece(n->bodies,
                              links->tool.piece[static_cast<std::size_t>(from.first_piece)].convex);
        }
        take_neighborhood(*n, *data);
        take_neighborhood(*shared::empty_world(), *links);
    }
    void run(const HandInput& hand = {}) {
        end_pushes(*links);
        follow_linkage(*data, k_number, linkage, *links, step_time);
        step(tool, *data, hand, step_time, out);
        push_linkage(*data, k_number, *links, step_time);
        step(linkage, *links, HandInput{}, step_time, links_out);
    }
    double step_time;
    Model tool;
    Model linkage;
    std::unique_ptr<Data> data;
    std::unique_ptr<Data> links;
    StepOutput out;
    StepOutput links_out;
};

} // namespace

TEST_CASE("what the tool's step foresees of a link is what the linkage does") {
    LinkageSpec spec = shared::chain(3);
    spec.links[0].joint.spring_stiffness = 0.05;
    spec.links[0].joint.damping = 0.001;
    spec.links[2].joint.spring_stiffness = 0.02;
    const Model model = shared::linkage_tool(spec);
    for (int link = 0; link < 3; ++link) {
        CAPTURE(link);
        auto data = std::make_unique<Data>();
        reset(model, *data, joints_at({0.4, 0.7, -0.3}));
        take_neighborhood(*shared::empty_world(Vec2(0.0, -9.81)), *data);
        StepOutput out;
        for (int i = 0; i < 5; ++i)
            step(model, *data, HandInput{}, k_free_step, out);
        const LinkResponse r = link_response(model, *data, link, k_free_step);
        const Twist before = data->tool.body[static_cast<std::size_t>(link)].velocity;
        const Wrench push(0.8, -1.3, 0.01);
        push_link(*data, link, push);
        step(model, *data, HandInput{}, k_free_step, out);
        const Twist change = data->tool.body[static_cast<std::size_t>(link)].velocity - before;
        const Twist foreseen = k_free_step * (r.mobility * push + r.acceleration);
        // J and the Coriolis terms change during the step
        CHECK((change - foreseen).norm() < 1e-2 * change.norm());
        CHECK(change.norm() > 1e-3);
    }
}

TEST_CASE("a tool that hits a door leaves with what the angular momentum about the hinge says") {
    Surface surface = shared::paper_surface();
    for (const double e : {0.0, 0.5, 1.0})
        for (const double at : {0.06, 0.18}) {
            CAPTURE(e);
            CAPTURE(at);
            surface.restitution = e;
            // the door lies along x; the tool comes from above, its lower edge 1 mm over the door
            Beside both(shared::box_tool(0.3), Pose(at, 0.016, 0.0), shared::door(), joints_at({0.0}),
                        surface);
            // a narrow tool, so that the lever is known
            both.data->tool.piece[0].convex = make_disc(Vec2::Zero(), 0.01);
            both.data->velocity = Twist(0.0, -0.5, 0.0);
            const double lever = at;
            const double inertia = 0.3 * 0.2 * 0.2 / 3.0;
            for (int i = 0; i < 6; ++i)
                both.run();
            const double before = -0.5;
            // -m l v = m l v' .. along the normal (0, 1): v' - l w' = -e (v - 0), m l (v - v') = I w' (w
            // counts up)
            const double share = inertia / (inertia + 0.3 * lever * lever);
            const double after = before - (1.0 + e) * before * share;
            const double turning = 0.3 * lever * (before - after) / inertia;
            CHECK(both.data->velocity.y() == doctest::Approx(after).epsilon(0.02));
            CHECK(both.links->linkage.velocity(0) == doctest::Approx(turning).epsilon(0.02));
        }
}

TEST_CASE(
    "a tool leaning on a door that leans on its stop gets its push back, at once and without a tremor") {
    LinkageSpec spec = shared::door();
    spec.links[0].joint.lower_limit = -0.05;
    Beside both(shared::box_tool(0.3), Pose(0.15, 0.016, 0.0), spec, joints_at({0.0}),
                shared::paper_surface());
    both.data->tool.piece[0].convex = make_disc(Vec2::Zero(), 0.01);
    HandInput hand;
    hand.held = true;
    hand.force = Wrench(0.0, -2.0, 0.0);
    // or the tool slides off
    hand.stiffness = Vec3(1000.0, 0.0, 0.0);
    hand.damping = Vec3(20.0, 0.0, 0.0);
    hand.target = Pose(0.15, 0.0, 0.0);
    for (int i = 0; i < 1500; ++i)
        both.run(hand);
    double least = 1e9;
    double most = -1e9;
    for (int i = 0; i < 300; ++i) {
        both.run(hand);
        least = std::min(least, both.out.contact.y());
        most = std::max(most, both.out.contact.y());
    }
    CHECK(most - least < 1e-3);
    CHECK(0.5 * (least + most) == doctest::Approx(2.0).epsilon(0.01));
    // the moment of the push on the stop of 150 N m/rad
    CHECK(both.links->linkage.position(0) == doctest::Approx(-0.05 - 2.0 * 0.15 / 150.0).epsilon(0.01));
}

TEST_CASE("tool and floating linkage share the momentum that the hand gives") {
    Surface surface = shared::paper_surface();
    // pushed along its axis, through its center of mass
    Beside both(shared::box_tool(0.3), Pose(-0.0305, 0.0, 0.0), shared::chain(1, BaseKind::floating),
                joints_at({0.05, 0.0, 0.0}), surface);
    both.data->tool.piece[0].convex = make_disc(Vec2::Zero(), 0.03);
    HandInput hand;
    hand.held = true;
    hand.force = Wrench(0.5, 0.0, 0.0);
    double given = 0.0;
    for (int i = 0; i < 400; ++i) {
        both.run(hand);
        given += 0.5 * k_free_step;
    }
    const double tool = both.data->velocity.x();
    const double link = both.links->linkage.velocity(0);
    CHECK(0.3 * tool + 0.1 * link == doctest::Approx(given).epsilon(1e-6));
    CHECK(link == doctest::Approx(tool).epsilon(0.01));
}

namespace {

struct MostEnergy {
    double one_at_a_time{0.0};
    double two_at_once{0.0};
};

// most of the start's energy that tool and arm have in 0.4 s after a random push, over 40 of them: where the
// tool hits one link after the other, and where it hits twice in a step
MostEnergy most_energy(double dt) {
    std::uint32_t seed = 11;
    const auto random = [&seed](double least, double most) {
        seed = seed * 1664525U + 1013904223U;
        return least + (most - least) * static_cast<double>(seed >> 8) / 16777216.0;
    };
    MostEnergy seen;
    for (int run = 0; run < 40; ++run) {
        double most = 0.0;
        bool two_at_once = false;
        Surface surface = shared::paper_surface();
        surface.restitution = random(0.0, 1.0);
        surface.static_friction = surface.dynamic_friction = random(0.0, 0.6);
        const double mass = random(0.02, 2.0);
        const double aside = random(0.02, 0.28);
        const double turned = random(-1.0, 1.0);
        const double second = random(-0.2, 0.2);
        const double third = random(-0.2, 0.2);
        const double drift = random(-0.3, 0.3);
        const double spin = random(-5.0, 5.0);
        Beside both(shared::box_tool(mass), Pose(aside, 0.12, turned), shared::chain(3),
                    joints_at({0.0, second, third}), surface, dt);
        both.data->velocity = Twist(drift, -1.0, spin);
        const auto energy = [&both] {
            const ToolModel& t = both.tool.tool;
            return 0.5 * t.mass * both.data->velocity.head<2>().squaredNorm() +
                   0.5 * t.inertia * both.data->velocity.z() * both.data->velocity.z() +
                   kinetic_energy(both.linkage.tool.linkage, both.links->linkage);
        };
        const double start = energy();
        for (int i = 0; i < static_cast<int>(0.4 / dt); ++i) {
            both.run();
            two_at_once = two_at_once || both.out.colliding > 1;
            most = std::max(most, energy() / start);
        }
        double& worst = two_at_once ? seen.two_at_once : seen.one_at_a_time;
        worst = std::max(worst, most);
    }
    return seen;
}

} // namespace

TEST_CASE("random pushes between a tool and an arm create no energy") {
    for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
        CAPTURE(dt);
        const MostEnergy seen = most_energy(dt);
        CHECK(seen.one_at_a_time > 0.99);
        CHECK(seen.one_at_a_time < 1.01);
        CHECK(seen.two_at_once < 1.01);
    }
}

TEST_CASE("two linkages that nobody holds share a hit by their masses: momentum, energy, restitution") {
    Surface surface = shared::paper_surface();
    for (const double e : {0.0, 0.5, 1.0})
        for (const double heavy : {0.1, 1.0, 20.0})
            for (const double at : {0.0, 0.04}) {
                CAPTURE(e);
                CAPTURE(heavy);
                CAPTURE(at);
                surface.restitution = e;
                LinkageSpec upper = shared::chain(1, BaseKind::floating);
                upper.links[0].mass = heavy;
                upper.links[0].inertia = heavy * 1e-4;
                // both lie along x, the lower one's center at the origin
                const LinkageSpec lower = shared::chain(1, BaseKind::floating);
                const Vec2 center = lower.links[0].center;
                Beside both(shared::linkage_tool(upper), Pose(at - center.x(), 0.016, 0.0), lower,
                            joints_at({-center.x(), 0.0, 0.0}), surface);
                both.data->tool.piece[0].convex = make_disc(Vec2::Zero(), 0.01);
                both.data->linkage.velocity[1] = -0.5;
                const double inertia = lower.links[0].inertia;
                for (int i = 0; i < 6; ++i)
                    both.run();
                const Twist& above = both.data->tool.body[0].velocity;
                const Twist& below = both.links->tool.body[0].velocity;
                const double mass = lower.links[0].mass;
                const double impulse = (1.0 + e) * 0.5 / (1.0 / heavy + 1.0 / mass + at * at / inertia);
                CHECK(above.y() == doctest::Approx(-0.5 + impulse / heavy).epsilon(0.01));
                CHECK(below.y() == doctest::Approx(-impulse / mass).epsilon(0.01));
                CHECK(below.z() == doctest::Approx(-impulse * at / inertia).epsilon(0.01));
            }
}

// A plate falls flat on a row of links. Fixed to each other they are one body, and the hit is central; hinged
// they may take what they like, but no more than the plate brought.
TEST_CASE("links that are hit at once answer as one linkage") {
    for (const bool hinged : {false, true})
        for (const int count : {2, 3, 5})
            for (const double mass : {0.1, 1.0})
                for (const double e : {0.0, 0.5, 1.0}) {
                    Model plate = shared::box_tool(mass);
                    const double length = 0.1 * count;
                    plate.tool.inertia = mass * length * length / 12.0;
                    plate.tool.shape.piece[0].convex = make_box(Vec2::Zero(), Vec2(length, 0.02));
                    LinkageSpec spec = shared::chain(count, BaseKind::floating);
                    for (std::size_t i = 1; i < spec.links.size() && !hinged; ++i)
                        spec.links[i].joint.kind = JointKind::fixed;
                    Surface s = shared::paper_surface();
                    s.restitution = e;
                    Beside w(plate, Pose(0.0, 0.0152, 0.0), spec, LinkageVector::Zero(hinged ? count + 2 : 3),
                             s);
                    const auto link = [&w](int i) -> const Body& {
                        return w.links->tool.body[static_cast<std::size_t>(i)];
                    };
                    w.data->pose.x() = 0.5 * (link(0).pose.x() + link(count - 1).pose.x());
                    w.data->velocity = Twist(0.0, -0.5, 0.0);
                    double most = 0.0;
                    for (int i = 0; i < 50; ++i) {
                        w.run();
                        const Twist& v = w.data->velocity;
                        most = std::max(most, 0.5 * mass * v.head<2>().squaredNorm() +
                                                  0.5 * plate.tool.inertia * v.z() * v.z() +
                                                  kinetic_energy(w.linkage.tool.linkage, w.links->linkage));
                    }
                    CAPTURE(hinged);
                    CAPTURE(count);
                    CAPTURE(mass);
                    CAPTURE(e);
                    CHECK(most < 1.01 * 0.5 * mass * 0.25);
                    if (hinged)
                        continue;
                    const double row = 0.1 * count;
                    const double after = -0.5 * (mass - e * row) / (mass + row);
                    CHECK(w.data->velocity.y() == doctest::Approx(after).epsilon(0.01));
                    CHECK(link(0).velocity.y() ==
                          doctest::Approx(-0.5 * (1.0 + e) * mass / (mass + row)).epsilon(0.01));
                }
}
