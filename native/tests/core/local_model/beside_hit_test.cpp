// A rigid tool hits a link of a floating linkage that runs beside it: momentum of the two, and the same scene
// with the linkage as the tool and a free body in place of the tool.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/local_model/free_linkage.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace haptics;

namespace {

constexpr std::uint64_t k_beside = 5;
constexpr double k_radius = 0.004;

struct Hit {
    Hit(Integrator integrator, int links, int hit, double e)
        : tool(shared::box_tool(0.2))
        , linkage(shared::linkage_tool(shared::chain(links, BaseKind::floating))) {
        tool.settings.integrator = linkage.settings.integrator = integrator;
        tool.tool.inertia = 0.5 * tool.tool.mass * k_radius * k_radius;
        tool.tool.shape.piece[0].convex = make_disc(Vec2::Zero(), k_radius);
        LinkageVector q = LinkageVector::Zero(links + 2);
        for (int i = 2; i < links + 2; ++i)
            q[i] = 0.3 * i - 0.8;
        reset(linkage, *beside, q);
        reset(linkage, *alone, q);
        take_neighborhood(*shared::empty_world(), *beside);

        Surface surface = shared::paper_surface();
        surface.restitution = e;
        const Pose center = beside->tool.body[static_cast<std::size_t>(hit)].pose;
        const Vec2 at = center.head<2>() + rotate(center.z(), Vec2(0.02, 0.00501 + k_radius));
        const Vec2 v = rotate(center.z(), Vec2(0.1, -0.5));
        reset(tool, *data, Pose(at.x(), at.y(), 0.0));
        data->velocity.head<2>() = v;
        momentum = tool.tool.mass * v;

        auto n = shared::empty_world();
        for (int i = 0; i < links; ++i) {
            const auto k = static_cast<std::size_t>(i);
            shared::add_body(n->bodies, k + 1, BodyKind::movable, surface, beside->tool.body[k].pose);
            Body& b = n->bodies.body[k];
            b.mass = linkage.tool.linkage.link[i].mass;
            b.inertia = linkage.tool.linkage.link[i].inertia;
            b.jointed = true;
            b.linkage = k_beside;
            b.link = i;
            b.mobility = Mat3::Identity();
            shared::add_piece(n->bodies, beside->tool.piece[k].convex);
        }
        take_neighborhood(*n, *data);

        auto other = shared::empty_world();
        shared::add_body(other->bodies, 9, BodyKind::movable, surface, data->pose);
        other->bodies.body[0].velocity = data->velocity;
        other->bodies.body[0].mass = tool.tool.mass;
        other->bodies.body[0].inertia = tool.tool.inertia;
        shared::add_piece(other->bodies, make_disc(Vec2::Zero(), k_radius));
        take_neighborhood(*other, *alone);
    }
    void run(double dt) {
        end_pushes(*beside);
        follow_linkage(*data, k_beside, linkage, *beside, dt);
        step(tool, *data, HandInput{}, dt, out);
        push_linkage(*data, k_beside, *beside, dt);
        StepOutput other;
        step(linkage, *beside, HandInput{}, dt, other);
        step(linkage, *alone, HandInput{}, dt, other);
    }
    [[nodiscard]] Vec2 total() const {
        return tool.tool.mass * data->velocity.head<2>() +
               total_momentum(linkage.tool.linkage, beside->linkage).linear;
    }
    Model tool;
    Model linkage;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    std::unique_ptr<Data> beside{std::make_unique<Data>()};
    std::unique_ptr<Data> alone{std::make_unique<Data>()};
    Vec2 momentum{0.0, 0.0};
    StepOutput out;
};

} // namespace

TEST_SUITE("hits on a linkage beside the tool") {
    TEST_CASE("tool and linkage keep their momentum, and part as they do with the linkage as the tool") {
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const int links : {1, 2, 4})
                for (int hit = 0; hit < links; ++hit)
                    for (const double e : {0.0, 0.5, 1.0}) {
                        Hit scene(integrator, links, hit, e);
                        int hits = 0;
                        for (int i = 0; i < 3; ++i) {
                            scene.run(0.001);
                            hits += scene.out.colliding;
                        }
                        CAPTURE(static_cast<int>(integrator));
                        CAPTURE(links);
                        CAPTURE(hit);
                        CAPTURE(e);
                        CHECK(hits == 1);
                        // the leapfrog finds the Coriolis terms of a push a step late
                        const double lost = integrator == Integrator::exact ? 4e-3 : 3e-2;
                        CHECK((scene.total() - scene.momentum).norm() < lost * scene.momentum.norm());
                        const LinkageVector& v = scene.alone->linkage.velocity;
                        CHECK((scene.beside->linkage.velocity - v).norm() < 0.03 * v.norm());
                        CHECK(v.norm() > 1.0);
                    }
    }
}
