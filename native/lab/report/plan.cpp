// What a scene need not do is of two kinds: bodies out of reach are not sent to the haptic loop at all
// (select_near, at the scene's tick), and stages with nothing to do are left out of its step (choose_plan).
// "Everything on" sends the whole scene and runs every stage.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/core/local_model/select_near.hpp>
#include <haptics/shared/linkage_tools.hpp>
#include <haptics/sweep/timing.hpp>

#include <algorithm>
#include <numbers>
#include <span>
#include <string>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

namespace {

struct Scene {
    const char* name;
    Model model;
    /// Everything there is, near or not.
    std::unique_ptr<Neighborhood> whole;
    LinkageVector start;
    /// How far from its place the tool's farthest point may be, m.
    double extent;
    /// Times cheaper that is asked; 0: nothing is.
    double asked;
};

LinkageVector pose(double x, double y, double angle) {
    return Pose(x, y, angle);
}

Surface rough_surface() {
    Surface rough = shared::paper_surface();
    rough.static_friction = 0.5;
    rough.dynamic_friction = 0.3;
    rough.restitution = 0.2;
    return rough;
}

// four walls 0.3 m away
std::unique_ptr<Neighborhood> room() {
    auto n = shared::empty_world();
    for (int side = 0; side < 4; ++side) {
        shared::add_body(n->bodies, static_cast<std::uint64_t>(side + 1), BodyKind::fixed, rough_surface(),
                         Pose(0.0, 0.0, 0.5 * std::numbers::pi * side));
        shared::add_piece(n->bodies, make_box(Vec2(0.0, -0.32), Vec2(0.7, 0.04)));
    }
    return n;
}

// 64 boxes of 20 mm in rows, from 0.3 m on
std::unique_ptr<Neighborhood> crowd(BodyKind kind) {
    auto n = shared::empty_world();
    for (int i = 0; i < 64; ++i) {
        const Pose at(0.3 + 0.05 * (i % 8), 0.3 + 0.05 * (i / 8), 0.0);
        const std::int32_t body =
            shared::add_body(n->bodies, static_cast<std::uint64_t>(i + 1), kind, rough_surface(), at);
        Body& b = n->bodies.body[static_cast<std::size_t>(body)];
        b.mass = 0.05;
        b.inertia = b.mass * 0.02 * 0.02 / 6.0;
        shared::add_piece(n->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    }
    return n;
}

std::vector<Scene> scenes() {
    constexpr double k_box = 0.0224;
    constexpr double k_arm = 0.4;
    std::vector<Scene> all;
    const auto add = [&all](const char* name, const Model& model, std::unique_ptr<Neighborhood> whole,
                            const LinkageVector& start, double extent, double asked) {
        all.push_back({name, model, std::move(whole), start, extent, asked});
    };
    const Model box = shared::box_tool();
    const Model arm = shared::linkage_tool(shared::arm());
    const LinkageVector free = pose(0.0, 0.02, 0.1);
    const LinkageVector low = pose(0.0, 0.013, 0.1);
    const LinkageVector bent = pose(-0.05, -0.3, 0.2);
    add("rigid tool, nothing near (four walls out of reach)", box, room(), free, k_box, 4.0);
    add("rigid tool, nothing in the scene", box, shared::empty_world(), free, k_box, 4.0);
    add("rigid tool, 64 bodies out of reach", box, crowd(BodyKind::fixed), free, k_box, 15.0);
    add("rigid tool, 64 moving platforms out of reach", box, crowd(BodyKind::kinematic), free, k_box, 15.0);
    add("rigid tool, 64 crates out of reach", box, crowd(BodyKind::movable), free, k_box, 15.0);
    add("rigid tool on a smooth wall", box, shared::floor_of(1), low, k_box, 0.0);
    add("rigid tool on a wall with friction", box, shared::floor_of(1, rough_surface()), low, k_box, 0.0);
    add("3-link arm, nothing near (four walls out of reach)", arm, room(), bent, k_arm, 0.0);
    add("3-link arm and a wall", arm, shared::floor_of(1, rough_surface()), bent, k_arm, 0.0);
    return all;
}

// what the scene sends: the bodies within reach, and the plan for them
std::unique_ptr<Neighborhood> sent(const Scene& scene) {
    // addons/haptics/environment/reach.gd for 60 ticks a second and a tool that moves at 0.2 m/s
    constexpr double k_time = 2.0 / 60.0 + 0.002;
    constexpr double k_way = 0.2 * k_time + 0.5 * 32.0 * k_time * k_time + 0.01;
    const ReachDisc disc{scene.model.tool.articulated ? Vec2(0.0, 0.0) : Vec2(scene.start.head<2>()),
                         scene.extent + k_way};
    const BodySet& set = scene.whole->bodies;
    const auto bounds = std::make_unique<BodyBounds>();
    compute_bounds(set, *bounds);
    std::vector<Candidate> candidates;
    for (std::int32_t i = 0; i < set.body_count; ++i) {
        const Body& b = set.body[static_cast<std::size_t>(i)];
        const auto first = static_cast<std::size_t>(b.first_piece);
        const auto count = static_cast<std::size_t>(b.piece_count);
        candidates.push_back(
            {b, std::span(set.piece).subspan(first, count), std::span(bounds->piece).subspan(first, count)});
    }
    auto near = std::make_unique<Neighborhood>(*scene.whole);
    static_cast<void>(select_near(candidates, std::span(&disc, 1), near->bodies));
    near->plan = choose_plan(scene.model, *near);
    return near;
}

constexpr int k_steps = 1000;

struct Motion {
    Motion(const Scene& scene, const Neighborhood& world, Integrator integrator)
        : model(scene.model)
        , data(std::make_unique<Data>()) {
        model.settings.integrator = integrator;
        reset(model, *data, scene.start);
        take_neighborhood(world, *data);
        hand.held = true;
        hand.stiffness = Vec3(500.0, 500.0, 0.5);
        hand.damping = Vec3(5.0, 5.0, 0.005);
        home = grip_pose(data->grip, data->pose);
    }
    void go() {
        hand.target = home + path()[static_cast<std::size_t>(count++ % k_steps)];
        step(model, *data, hand, 1e-3, out);
    }
    // where the hand goes, made before anything is timed
    static const std::vector<Pose>& path() {
        static const std::vector<Pose> made = [] {
            std::vector<Pose> all;
            for (int i = 1; i <= k_steps; ++i) {
                const double t = 1e-3 * i;
                all.emplace_back(0.01 * std::sin(9.0 * t), -0.01 + 0.01 * std::cos(7.0 * t),
                                 0.1 * std::sin(5.0 * t));
            }
            return all;
        }();
        return made;
    }
    Model model;
    std::unique_ptr<Data> data;
    HandInput hand;
    Pose home;
    StepOutput out;
    int count{0};
};

// largest difference of pose and velocity over a second
double difference(const Scene& scene, const Neighborhood& planned, Integrator integrator) {
    Motion with(scene, planned, integrator);
    Motion without(scene, *scene.whole, integrator);
    double worst = 0.0;
    for (int i = 0; i < k_steps; ++i) {
        with.go();
        without.go();
        worst = std::max({worst, (with.data->pose - without.data->pose).cwiseAbs().maxCoeff(),
                          (with.data->velocity - without.data->velocity).cwiseAbs().maxCoeff()});
    }
    return worst;
}

sweep::Spread cost(const Scene& scene, const Neighborhood& world, Integrator integrator, int repeats) {
    std::unique_ptr<Motion> motion;
    return sweep::time_calls([&] { motion = std::make_unique<Motion>(scene, world, integrator); },
                             [&] { motion->go(); }, k_steps, repeats);
}

} // namespace

void write_plan(const Options& options) {
    CsvFile csv(options.folder / "plan.csv",
                {"scene", "integrator", "kernel", "bodies", "bodies_sent", "left_out", "ns_per_step_planned",
                 "ns_planned_low", "ns_planned_high", "ns_per_step_everything", "ns_everything_low",
                 "ns_everything_high", "times_cheaper", "times_asked", "largest_difference"});
    const std::vector<Scene> all = scenes();
    double done = 0.0;
    for (const Scene& scene : all) {
        const std::unique_ptr<Neighborhood> planned = sent(scene);
        const int away = scene.whole->bodies.body_count - planned->bodies.body_count;
        std::string left_out;
        if (away > 0)
            left_out = std::to_string(away) + " bodies: out of reach until the next tick";
        for (const PlanLine& line : describe(planned->plan))
            if (!line.runs)
                left_out += (left_out.empty() ? "" : "; ") + std::string(line.stage) + ": " +
                            std::string(line.reason);
        for (const Integrator integrator : {Integrator::linearly_implicit, Integrator::semi_implicit}) {
            const sweep::Spread with = cost(scene, *planned, integrator, options.repeats());
            const sweep::Spread without = cost(scene, *scene.whole, integrator, options.repeats());
            csv.row({scene.name, name_of(integrator), kernel_name(scene.model),
                     scene.whole->bodies.body_count, planned->bodies.body_count, left_out, with.median,
                     with.low, with.high, without.median, without.low, without.high,
                     without.median / with.median, scene.asked, difference(scene, *planned, integrator)});
        }
        show_progress("plan", ++done / static_cast<double>(all.size()));
    }
    csv.finish();
}

} // namespace haptics::report
