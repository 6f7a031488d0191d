// The tool as a linkage: the same model as the rigid tool where both can do it, and the laws of mechanics
// where only the linkage can.

#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <support/allocation_guard.hpp>

using namespace haptics;
using shared::linkage_tool;

namespace {

std::unique_ptr<Data> at(const Model& model, const LinkageVector& start) {
    auto data = std::make_unique<Data>();
    reset(model, *data, start);
    return data;
}

LinkageVector coordinates(std::initializer_list<double> values) {
    LinkageVector q(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const double value : values)
        q[i++] = value;
    return q;
}

Surface rough_paper() {
    Surface s = shared::paper_surface();
    s.static_friction = 0.5;
    s.dynamic_friction = 0.3;
    s.restitution = 0.4;
    return s;
}

// a chain thrown at a floor 5 cm below its base, with friction and restitution
struct Thrown {
    Thrown(const LinkageSpec& spec, int dense_freedoms, Integrator integrator,
           const Surface& surface = rough_paper())
        : model(linkage_tool(spec)) {
        model.settings.dense_freedoms = dense_freedoms;
        model.settings.integrator = integrator;
        LinkageVector q(model.tool.linkage.freedoms);
        shared::Random random(5);
        for (Eigen::Index i = 0; i < q.size(); ++i)
            q[i] = random.uniform(-0.3, 0.3);
        if (spec.base == BaseKind::floating)
            q.head<3>() = Vec3(0.0, -0.02, 0.1);
        else
            q[0] = -0.3;
        data = at(model, q);
        for (Eigen::Index i = 0; i < q.size(); ++i)
            data->linkage.velocity[i] = random.uniform(-2.0, 2.0);
        auto floor = shared::floor_of(1, surface);
        floor->gravity = Vec2(0.0, -9.81);
        floor->bodies.piece[0].convex = make_box(Vec2(0.0, -0.10), Vec2(4.0, 0.1));
        take_neighborhood(*floor, *data);
    }
    Model model;
    std::unique_ptr<Data> data;
};

} // namespace

TEST_SUITE("linkage tool") {
    TEST_CASE("a linkage of one floating link moves as the rigid tool does") {
        const Model rigid = shared::box_tool(0.3);
        LinkageSpec spec = shared::rigid_tool();
        spec.links[0].inertia = rigid.tool.inertia;
        Model one = linkage_tool(spec);
        one.tool.shape = rigid.tool.shape;
        for (const Integrator integrator : {Integrator::semi_implicit, Integrator::linearly_implicit}) {
            Model a = rigid;
            Model b = one;
            a.settings.integrator = b.settings.integrator = integrator;
            auto left = at(a, Pose(0.0, 0.014, 0.05));
            auto right = at(b, Pose(0.0, 0.014, 0.05));
            for (Data* data : {left.get(), right.get()}) {
                auto floor = shared::floor_of(3, rough_paper());
                floor->gravity = Vec2(0.0, -9.81);
                take_neighborhood(*floor, *data);
            }
            HandInput hand;
            hand.held = true;
            hand.stiffness = Vec3(500.0, 500.0, 0.5);
            hand.damping = Vec3(5.0, 5.0, 0.005);
            StepOutput out_left;
            StepOutput out_right;
            double worst = 0.0;
            for (int i = 0; i < 1000; ++i) {
                const double t = 0.001 * i;
                hand.target =
                    Pose(0.02 * std::sin(9.0 * t), 0.012 * std::cos(7.0 * t), 0.2 * std::sin(5.0 * t));
                step(a, *left, hand, 0.001, out_left);
                step(b, *right, hand, 0.001, out_right);
                worst = std::max(worst, (left->pose - right->pose).norm());
                worst = std::max(worst, 1e-3 * (out_left.contact - out_right.contact).norm());
                REQUIRE(out_left.contacts == out_right.contacts);
            }
            CHECK(worst < 1e-9);
        }
    }

    TEST_CASE("row by row or with a dense matrix, a chain that hits the floor moves the same") {
        for (const Integrator integrator : {Integrator::semi_implicit, Integrator::linearly_implicit})
            for (const BaseKind base : {BaseKind::grounded, BaseKind::floating})
                for (const int links : {3, 6, 12}) {
                    LinkageSpec spec = shared::chain(links, base);
                    for (LinkSpec& link : spec.links) {
                        link.joint.damping = 1e-4;
                        link.joint.friction = 2e-3;
                        link.joint.lower_limit = -1.0;
                        link.joint.upper_limit = 1.0;
                    }
                    // a collision with friction in five places at once has more than one solution
                    const Surface surface = links < 12 ? rough_paper() : shared::paper_surface();
                    Thrown dense(spec, 66, integrator, surface);
                    Thrown rows(spec, 0, integrator, surface);
                    StepOutput a;
                    StepOutput b;
                    CAPTURE(links);
                    CAPTURE(static_cast<int>(base));
                    CAPTURE(static_cast<int>(integrator));
                    int contacts = 0;
                    // chaos sets in later: the two agree while rounding has not grown
                    for (int i = 0; i < 60; ++i) {
                        step(dense.model, *dense.data, HandInput{}, 0.0005, a);
                        step(rows.model, *rows.data, HandInput{}, 0.0005, b);
                        contacts += a.contacts;
                        CAPTURE(i);
                        CAPTURE((dense.data->linkage.position - rows.data->linkage.position).norm());
                        CAPTURE((dense.data->linkage.velocity - rows.data->linkage.velocity).norm());
                        REQUIRE(a.contacts == b.contacts);
                    }
                    CHECK(contacts > 0);
                    CHECK((dense.data->linkage.position - rows.data->linkage.position).norm() < 1e-8);
                    CHECK((dense.data->linkage.velocity - rows.data->linkage.velocity).norm() < 1e-5);
                }
    }

    TEST_CASE("a free arm swings as a reference of a thousandth of its error says") {
        Model model = linkage_tool(shared::arm());
        const LinkageVector start = coordinates({0.4, -0.9, 0.7});
        const auto swing = [&](double h) {
            auto data = at(model, start);
            data->linkage.velocity = coordinates({3.0, -2.0, 4.0});
            take_neighborhood(*shared::empty_world(Vec2(0.0, -9.81)), *data);
            StepOutput out;
            for (int i = 0; i < static_cast<int>(std::lround(0.5 / h)); ++i)
                step(model, *data, HandInput{}, h, out);
            return LinkageVector(data->linkage.position);
        };
        LinkageSpec spec = shared::arm();
        spec.gravity = Vec2(0.0, -9.81);
        LinkageModel reference;
        REQUIRE(build_model(spec, reference).empty());
        LinkageData truth;
        reset(reference, truth);
        truth.position = start;
        truth.velocity = coordinates({3.0, -2.0, 4.0});
        for (int i = 0; i < 200000; ++i) {
            ArticulatedFactor factor;
            LinkageVector none = LinkageVector::Zero(3);
            LinkageVector acceleration;
            // explicit midpoint, 2.5 us
            LinkageData middle = truth;
            prepare_dynamics(reference, middle);
            forward_dynamics(reference, middle, none, factor, acceleration);
            middle.position += 1.25e-6 * truth.velocity;
            middle.velocity += 1.25e-6 * acceleration;
            prepare_dynamics(reference, middle);
            forward_dynamics(reference, middle, none, factor, acceleration);
            truth.position += 2.5e-6 * middle.velocity;
            truth.velocity += 2.5e-6 * acceleration;
        }
        const double coarse = (swing(1e-3) - truth.position).norm();
        const double fine = (swing(1e-4) - truth.position).norm();
        MESSAGE("error after 0.5 s: " << coarse << " rad at 1 ms, " << fine << " at 0.1 ms");
        CHECK(coarse < 0.05);
        CHECK(fine < 0.2 * coarse);
    }

    TEST_CASE("energy of a held and thrown chain never grows through contacts, limits and friction") {
        for (const int links : {2, 3, 5, 12}) {
            LinkageSpec spec = shared::chain(links);
            for (LinkSpec& link : spec.links) {
                link.joint.lower_limit = -1.2;
                link.joint.upper_limit = 1.2;
            }
            Thrown t(spec, 8, Integrator::linearly_implicit);
            // without gravity every loss is a contact's, and only the discrete motion can add
            auto floor = shared::floor_of(1, rough_paper());
            floor->sequence = 2;
            floor->bodies.piece[0].convex = make_box(Vec2(0.0, -0.10), Vec2(4.0, 0.1));
            take_neighborhood(*floor, *t.data);
            StepOutput out;
            step(t.model, *t.data, HandInput{}, 1e-4, out);
            const double before = out.stored_energy;
            double most = before;
            for (int i = 0; i < 20000; ++i) {
                step(t.model, *t.data, HandInput{}, 1e-4, out);
                most = std::max(most, out.stored_energy);
            }
            CAPTURE(links);
            CHECK(most < 1.02 * before);
            CHECK(out.stored_energy < 0.95 * before);
        }
    }

    TEST_CASE("a limit stops the joint, and its spring gives what the torque asks") {
        LinkageSpec spec = shared::door();
        spec.links[0].joint.upper_limit = 0.5;
        spec.links[0].joint.limit_stiffness = 80.0;
        spec.links[0].joint.limit_damping = 0.1;
        for (const Integrator integrator : {Integrator::semi_implicit, Integrator::linearly_implicit}) {
            Model model = linkage_tool(spec);
            model.settings.integrator = integrator;
            model.tool.grip = Grip{0, Vec2(0.1, 0.0), false};
            auto data = at(model, coordinates({0.0}));
            take_neighborhood(*shared::empty_world(), *data);
            HandInput hand;
            hand.held = true;
            StepOutput out;
            double farthest = 0.0;
            for (int i = 0; i < 4000; ++i) {
                // 1 N square to the door at its end
                const double q = data->linkage.position[0];
                hand.force = Wrench(-std::sin(q), std::cos(q), 0.0);
                step(model, *data, hand, 0.001, out);
                farthest = std::max(farthest, data->linkage.position[0]);
            }
            CHECK(data->linkage.position[0] == doctest::Approx(0.5 + 0.2 / 80.0).epsilon(1e-6));
            // the impulse took the speed away: hardly deeper than the push itself
            CHECK(farthest < 0.5 + 2.5 * 0.2 / 80.0);
            CHECK(data->linkage.velocity[0] == doctest::Approx(0.0).epsilon(1e-9));
        }
    }

    TEST_CASE("joint friction holds below its bound without creep, and brakes with it beyond") {
        LinkageSpec spec = shared::door();
        spec.links[0].joint.friction = 0.1;
        for (const Integrator integrator : {Integrator::semi_implicit, Integrator::linearly_implicit}) {
            Model model = linkage_tool(spec);
            model.settings.integrator = integrator;
            model.tool.grip = Grip{0, Vec2(0.1, 0.0), false};
            auto data = at(model, coordinates({0.0}));
            take_neighborhood(*shared::empty_world(), *data);
            HandInput hand;
            hand.held = true;
            StepOutput out;
            const auto push = [&](double force, int steps) {
                for (int i = 0; i < steps; ++i) {
                    const double q = data->linkage.position[0];
                    hand.force = force * Wrench(-std::sin(q), std::cos(q), 0.0);
                    step(model, *data, hand, 0.001, out);
                }
            };
            push(0.495, 1000); // 99 % of 0.5 N at 0.2 m
            const double settled = data->linkage.position[0];
            push(0.495, 60000);
            CHECK(std::abs(data->linkage.position[0] - settled) < 1e-12);
            push(1.0, 500); // (0.2 - 0.1) N m on 4e-3 kg m^2 for 0.5 s
            CHECK(data->linkage.velocity[0] == doctest::Approx(12.5).epsilon(0.01));
            push(0.0, 490);
            CHECK(data->linkage.velocity[0] == doctest::Approx(0.25).epsilon(0.1));
            push(0.0, 100);
            CHECK(std::abs(data->linkage.velocity[0]) < 1e-5); // the stuck spring still swings out
        }
    }

    TEST_CASE("every link feels the wall that it touches") {
        // an arm stretched along x above a floor; a small block under each link in turn
        for (int link = 0; link < 3; ++link) {
            Model model = linkage_tool(shared::arm());
            auto data = at(model, coordinates({0.0, 0.0, 0.0}));
            auto n = shared::empty_world(Vec2(0.0, -9.81));
            shared::add_body(n->bodies, 9, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
            shared::add_piece(n->bodies, make_box(Vec2(0.1 * link + 0.05, -0.0152), Vec2(0.02, 0.02)));
            take_neighborhood(*n, *data);
            StepOutput out;
            int touched = 0;
            for (int i = 0; i < 20; ++i) {
                step(model, *data, HandInput{}, 0.001, out);
                for (int k = 0; k < data->patches.count; ++k)
                    if (data->patches.patch[static_cast<std::size_t>(k)].memory.state != ContactState::none) {
                        CHECK(data->patches.patch[static_cast<std::size_t>(k)].body_a == link);
                        ++touched;
                    }
            }
            CAPTURE(link);
            CHECK(touched > 0);
        }
    }

    TEST_CASE("a door pushed against a stop gives the lever's force") {
        for (const Integrator integrator : {Integrator::semi_implicit, Integrator::linearly_implicit}) {
            Model model = linkage_tool(shared::door());
            model.settings.integrator = integrator;
            model.tool.grip = Grip{0, Vec2(0.1, 0.0), false};
            auto data = at(model, coordinates({0.0}));
            auto n = shared::empty_world();
            shared::add_body(n->bodies, 9, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
            shared::add_piece(n->bodies, make_disc(Vec2(0.12, 0.0152), 0.01));
            take_neighborhood(*n, *data);
            HandInput hand;
            hand.held = true;
            hand.force = Wrench(0.0, 2.0, 0.0);
            StepOutput out;
            for (int i = 0; i < 4000; ++i)
                step(model, *data, hand, 0.001, out);
            CHECK(out.contacts == 1);
            CHECK(out.contact.head<2>().norm() == doctest::Approx(2.0 * 0.2 / 0.12).epsilon(0.005));
        }
    }

    TEST_CASE("a long whip keeps its energy at any speed, and stays finite") {
        for (const int links : {24, 48})
            for (const double speed : {0.5, 5.0, 50.0})
                for (const double h : {1e-3, 1e-2}) {
                    Model model = linkage_tool(shared::chain(links));
                    LinkageVector q(links);
                    LinkageVector v(links);
                    shared::Random random(5);
                    for (int i = 0; i < links; ++i) {
                        q[i] = random.uniform(-0.3, 0.3);
                        v[i] = random.uniform(-speed, speed);
                    }
                    auto data = at(model, q);
                    data->linkage.velocity = v;
                    take_neighborhood(*shared::empty_world(), *data);
                    StepOutput out;
                    step(model, *data, HandInput{}, h, out);
                    const double before = out.stored_energy;
                    double most = 0.0;
                    for (int i = 0; i < 1000; ++i) {
                        step(model, *data, HandInput{}, h, out);
                        most = std::max(most, out.stored_energy);
                    }
                    CAPTURE(links);
                    CAPTURE(speed);
                    CAPTURE(h);
                    CHECK(most <= 1.06 * before);
                    CHECK(data->linkage.position.allFinite());
                }
    }

    TEST_CASE("a step of a linkage takes nothing from the heap, for any number of links") {
        for (const int links : {1, 2, 3, 4, 5, 9, 20, 48, 64})
            for (const BaseKind base : {BaseKind::grounded, BaseKind::floating}) {
                LinkageSpec spec = shared::chain(links, base);
                for (LinkSpec& link : spec.links) {
                    link.joint.friction = 1e-3;
                    link.joint.damping = 1e-4;
                    link.joint.lower_limit = -1.0;
                    link.joint.upper_limit = 1.0;
                }
                Thrown t(spec, 8, Integrator::linearly_implicit);
                HandInput hand;
                hand.held = true;
                hand.stiffness = Vec3(500.0, 500.0, 0.5);
                StepOutput out;
                std::uint64_t taken = 0;
                {
                    const testing::AllocationGuard guard;
                    for (int i = 0; i < 60; ++i)
                        step(t.model, *t.data, hand, 0.001, out);
                    taken = guard.allocations();
                }
                CAPTURE(links);
                CHECK(taken == 0);
                CHECK(t.data->linkage.position.allFinite());
            }
    }
}
