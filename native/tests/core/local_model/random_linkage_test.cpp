// shared::Random trees of revolute, prismatic and fixed joints as tools, grounded and floating, among random
// boxes and discs, held and free: what has to hold whatever the scene is.

#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <numbers>

using namespace haptics;
using shared::linkage_tool;

namespace {

struct LinkageScene {
    Model model;
    std::unique_ptr<Data> data;
    /// Stiffness of the softest wall, N/m.
    double softest{1e300};
};

Surface random_surface(shared::Random& random) {
    Surface s;
    s.stiffness = std::pow(10.0, random.uniform(2.0, 7.0));
    s.damping = std::pow(10.0, random.uniform(-1.0, 2.5));
    s.dynamic_friction = random.uniform(0.0, 1.0);
    s.static_friction = s.dynamic_friction + random.uniform(0.0, 0.5);
    s.restitution = random.uniform(0.0, 1.0);
    return s;
}

// a linkage with random joints, limits, friction, damping and springs, at rest or in motion
LinkageScene random_scene(shared::Random& random, bool with_gravity) {
    shared::RandomLinkage kind;
    kind.links = random.integer(1, 14);
    kind.base = random.integer(0, 1) == 0 ? BaseKind::grounded : BaseKind::floating;
    kind.serial = random.integer(0, 1) == 0;
    LinkageSpec spec = shared::random_linkage(random, kind);
    for (LinkSpec& link : spec.links) {
        if (random.integer(0, 2) == 0) {
            link.joint.lower_limit = random.uniform(-1.5, -0.1);
            link.joint.upper_limit = random.uniform(0.1, 1.5);
        }
        link.joint.friction = random.integer(0, 2) == 0 ? random.uniform(0.0, 0.05) : 0.0;
        link.joint.damping = random.integer(0, 2) == 0 ? random.uniform(0.0, 0.01) : 0.0;
        link.joint.spring_stiffness = random.integer(0, 2) == 0 ? random.uniform(0.0, 1.0) : 0.0;
    }
    if (spec.base == BaseKind::grounded && spec.links[0].joint.kind == JointKind::fixed)
        spec.links[0].joint.kind = JointKind::revolute;
    LinkageScene scene;
    scene.model = linkage_tool(spec, random.uniform(0.004, 0.02));
    scene.model.settings.integrator =
        random.integer(0, 1) == 0 ? Integrator::linearly_implicit : Integrator::semi_implicit;
    scene.model.settings.dense_freedoms = random.integer(0, 1) == 0 ? 2 : 66;
    scene.model.tool.grip =
        Grip{random.integer(0, kind.links - 1), Vec2(0.01, 0.0), random.integer(0, 1) == 0};
    const int n = scene.model.tool.linkage.freedoms;
    LinkageVector q(n);
    for (int i = 0; i < n; ++i)
        q[i] = random.uniform(-0.09, 0.09); // within the narrowest limits
    scene.data = std::make_unique<Data>();
    reset(scene.model, *scene.data, q);
    for (int i = 0; i < n; ++i)
        scene.data->linkage.velocity[i] = random.uniform(-1.0, 1.0);
    auto n1 = shared::empty_world();
    if (with_gravity) {
        // one draw a statement: the order of arguments is the compiler's choice
        const double down = random.uniform(-10.0, 0.0);
        n1->gravity = Vec2(random.uniform(-5.0, 5.0), down);
    }
    // a ring of matter around the linkage, out of it at the start
    for (int i = 0; i < 24; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 24.0;
        const double radius = random.uniform(0.6, 0.9);
        const Surface surface = random_surface(random);
        scene.softest = std::min(scene.softest, surface.stiffness);
        shared::add_body(n1->bodies, static_cast<std::uint64_t>(100 + i), BodyKind::fixed, surface,
                         Pose(radius * std::cos(angle), radius * std::sin(angle), angle));
        if (i % 2 == 0)
            shared::add_piece(n1->bodies, make_box(Vec2::Zero(), Vec2(0.05, 0.25)));
        else
            shared::add_piece(n1->bodies, make_disc(Vec2::Zero(), 0.08));
    }
    take_neighborhood(*n1, *scene.data);
    return scene;
}

std::uint64_t hash_of(const LinkageVector& v, std::uint64_t hash) {
    for (Eigen::Index i = 0; i < v.size(); ++i) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &v[i], sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3ULL;
    }
    return hash;
}

} // namespace

TEST_SUITE("random linkages") {
    TEST_CASE("free linkages among walls: finite, no energy out of nothing, no deep overlap") {
        shared::Random random(77);
        int contacts = 0;
        int collisions = 0;
        for (int trial = 0; trial < 200; ++trial) {
            LinkageScene scene = random_scene(random, false);
            StepOutput out;
            step(scene.model, *scene.data, HandInput{}, 5e-4, out);
            const double before = out.stored_energy;
            double most = before;
            double deepest = 0.0;
            for (int i = 0; i < 1000; ++i) {
                step(scene.model, *scene.data, HandInput{}, 5e-4, out);
                most = std::max(most, out.stored_energy);
                deepest = std::max(deepest, out.max_penetration);
                contacts += out.contacts;
                collisions += out.colliding;
                REQUIRE(scene.data->linkage.position.allFinite());
                REQUIRE(scene.data->linkage.velocity.allFinite());
            }
            CAPTURE(trial);
            CAPTURE(static_cast<int>(scene.model.settings.integrator));
            // the leapfrog's energy breathes by a few percent; semi-implicit walls may give a little back
            CHECK(most <= 1.1 * before + 1e-6);
            // no deeper than all the energy in the softest spring, and what a step moves
            CHECK(deepest <= std::sqrt(2.0 * before / scene.softest) + 0.002);
        }
        CHECK(contacts > 1000);
        CHECK(collisions > 50);
    }

    TEST_CASE("held and pulled about under gravity: finite, and never faster than the pull can make it") {
        shared::Random random(78);
        for (int trial = 0; trial < 100; ++trial) {
            LinkageScene scene = random_scene(random, true);
            // walls up to 1e7 N/m at 1 ms are beyond the semi-implicit integrator
            scene.model.settings.integrator = Integrator::linearly_implicit;
            HandInput hand;
            hand.held = true;
            hand.stiffness = Vec3(800.0, 800.0, 1.0);
            hand.damping = Vec3(8.0, 8.0, 0.01);
            hand.max_force = 20.0;
            hand.max_torque = 1.0;
            const Pose start = grip_pose(scene.data->grip, scene.data->pose);
            StepOutput out;
            double work = 0.0;
            Pose last = start;
            step(scene.model, *scene.data, hand, 1e-3, out);
            const double before = out.stored_energy;
            for (int i = 0; i < 1500; ++i) {
                const double t = 1e-3 * i;
                hand.target =
                    start + 0.1 * Pose(std::sin(11.0 * t), 1.0 - std::cos(7.0 * t), std::sin(5.0 * t));
                hand.target_velocity =
                    0.1 * Pose(11.0 * std::cos(11.0 * t), 7.0 * std::sin(7.0 * t), 5.0 * std::cos(5.0 * t));
                step(scene.model, *scene.data, hand, 1e-3, out);
                const Pose grip = grip_pose(scene.data->grip, scene.data->pose);
                work += out.coupling.dot(grip - last) + out.source_work;
                last = grip;
                REQUIRE(scene.data->linkage.position.allFinite());
            }
            CAPTURE(trial);
            // first-order books: what it has is what the hand and gravity gave, less what was lost
            CHECK(out.stored_energy <= before + std::abs(work) + 0.05);
            CHECK(out.coupling.head<2>().norm() <= 20.0 * (1.0 + 1e-9));
        }
    }

    TEST_CASE("the same scene gives the same bits") {
        std::uint64_t hashes[2]{};
        for (std::uint64_t& hash : hashes) {
            shared::Random random(79);
            hash = 0xcbf29ce484222325ULL;
            for (int trial = 0; trial < 20; ++trial) {
                LinkageScene scene = random_scene(random, true);
                StepOutput out;
                for (int i = 0; i < 300; ++i)
                    step(scene.model, *scene.data, HandInput{}, 1e-3, out);
                hash = hash_of(scene.data->linkage.position, hash);
                hash = hash_of(scene.data->linkage.velocity, hash);
            }
        }
        CHECK(hashes[0] == hashes[1]);
    }
}
