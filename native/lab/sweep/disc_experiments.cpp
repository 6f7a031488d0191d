// The experiments on a rigid tool. The tool is a disc that is too heavy to turn, so that the independent
// reference (reference_disc.hpp) describes the same motion exactly.

#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/sweep/experiment.hpp>
#include <haptics/sweep/reference_disc.hpp>

#include <cmath>
#include <numbers>

namespace haptics::sweep {

namespace {

constexpr double k_radius = 0.01;
constexpr double k_mass = 0.3;
constexpr double k_inertia = 1e12;
constexpr double k_collision_speed = 0.005;

using Path = std::function<void(double, Vec3&, Vec3&)>;

struct DiscSetup {
    bool wall{true};
    Surface surface;
    /// Gap between tool and wall at the start, m.
    double gap{0.0};
    Vec2 gravity{0.0, 0.0};
    /// Steady force of the hand, N.
    Vec2 push{0.0, 0.0};
    /// The hand's spring-damper, and where its other end goes.
    Vec3 stiffness{0.0, 0.0, 0.0};
    Vec3 damping{0.0, 0.0, 0.0};
    Path path;
};

double energy(const DiscSetup& setup, const Vec2& position, const Vec2& velocity) {
    const double gap = position.y() - k_radius;
    const double spring = setup.wall && gap < 0.0 ? 0.5 * setup.surface.stiffness * gap * gap : 0.0;
    return 0.5 * k_mass * velocity.squaredNorm() + spring -
           (k_mass * setup.gravity + setup.push).dot(position);
}

Integrator integrator_of(Scheme scheme) {
    if (scheme == Scheme::semi_implicit)
        return Integrator::semi_implicit;
    return scheme == Scheme::exact ? Integrator::exact : Integrator::linearly_implicit;
}

class DiscRun final : public Run {
  public:
    DiscRun(const DiscSetup& setup, const Setting& setting)
        : setup_(setup)
        , data_(std::make_unique<Data>())
        , step_(1.0 / setting.rate) {
        ToolModel& tool = model_.tool;
        tool.mass = k_mass;
        tool.inertia = k_inertia;
        tool.shape.body_count = tool.shape.piece_count = 1;
        tool.shape.body[0].kind = BodyKind::tool;
        tool.shape.body[0].surface = neutral_surface();
        tool.shape.body[0].piece_count = 1;
        tool.shape.piece[0].id = 1;
        tool.shape.piece[0].convex = make_disc(Vec2::Zero(), k_radius);
        LocalModelSettings& s = model_.settings;
        s.integrator = integrator_of(setting.scheme);
        s.strictly_semi_implicit = true; // the method itself is compared
        s.contact_mode =
            setting.method == Method::penalty ? ContactMode::penalty : ContactMode::penalty_impulse;
        s.collision_method =
            setting.method == Method::paper ? CollisionMethod::paper : CollisionMethod::poisson;
        s.collision_speed = k_collision_speed;
        reset(model_, *data_, Pose(0.0, k_radius + setup.gap, 0.0));
        Neighborhood scene;
        scene.sequence = 1;
        scene.gravity = setup.gravity;
        if (setup.wall) {
            scene.bodies.body_count = scene.bodies.piece_count = 1;
            Body& body = scene.bodies.body[0];
            body.id = 1;
            body.surface = setup.surface;
            body.piece_count = 1;
            scene.bodies.piece[0].id = 1;
            scene.bodies.piece[0].convex = make_half_plane(Vec2::Zero(), Vec2(0.0, 1.0));
        }
        scene.plan = choose_plan(model_, scene);
        take_neighborhood(scene, *data_);
        hand_.held = true;
        hand_.stiffness = setup.stiffness;
        hand_.damping = setup.damping;
        hand_.force.head<2>() = setup.push;
        if (setup_.path)
            setup_.path(0.0, hand_.target, hand_.target_velocity);
    }

    void step() override {
        ++count_;
        if (setup_.path) {
            // the hand as a straight line through what two samples of it show
            const Pose before = hand_.target;
            Twist unused;
            setup_.path(static_cast<double>(count_) * step_, hand_.target, unused);
            hand_.target_velocity = (hand_.target - before) / step_;
        }
        haptics::step(model_, *data_, hand_, step_, out_);
        impulse_ += step_ * out_.contact.head<2>() + out_.collision_impulse.head<2>();
    }

    Sample sample() override {
        const Vec2 position = data_->pose.head<2>();
        return {position, energy(setup_, position, data_->velocity.head<2>()), impulse_};
    }

  private:
    DiscSetup setup_;
    Model model_;
    std::unique_ptr<Data> data_;
    HandInput hand_;
    StepOutput out_;
    double step_;
    long count_{0};
    Vec2 impulse_{0.0, 0.0};
};

Track reference_track(const DiscSetup& setup, double seconds, Method method, int refinement) {
    ReferenceDisc disc{};
    disc.mass = k_mass;
    disc.radius = k_radius;
    disc.pose = Pose(0.0, k_radius + setup.gap, 0.0);
    disc.gravity = setup.gravity + setup.push / k_mass;
    disc.spring = setup.stiffness;
    disc.damper = setup.damping;
    disc.path = setup.path;
    if (setup.path)
        setup.path(0.0, disc.target, disc.target_velocity);
    if (method != Method::penalty)
        disc.collision_speed = k_collision_speed;
    if (setup.wall) {
        const Surface& s = setup.surface;
        ReferenceWall wall{};
        wall.normal = Vec2(0.0, 1.0);
        wall.point = Vec2::Zero();
        wall.stiffness = s.stiffness;
        wall.damping = s.damping;
        wall.static_friction = s.static_friction;
        wall.dynamic_friction = s.dynamic_friction;
        wall.restitution = s.restitution;
        wall.pressing = setup.gap < 0.0;
        wall.mode = wall.pressing && s.static_friction > 0.0 ? 1 : 0;
        disc.walls.push_back(wall);
    }
    const double h = 1e-4 / static_cast<double>(1 << refinement);
    Track track;
    const auto samples = std::lround(seconds / k_sample_time);
    for (long i = 0; i < samples; ++i) {
        disc.advance(k_sample_time, h);
        // an impulse on walls pushes along the normal and its perpendicular
        Vec2 impulse = Vec2::Zero();
        for (const ReferenceWall& w : disc.walls)
            impulse += w.impulse.x() * w.normal + w.impulse.y() * perpendicular(w.normal);
        const Vec2 position = disc.pose.head<2>();
        track.push_back({position, energy(setup, position, disc.velocity.head<2>()), impulse});
    }
    return track;
}

Experiment experiment_of(const DiscSetup& setup, double seconds) {
    Experiment e;
    e.seconds = seconds;
    e.schemes = {Scheme::semi_implicit, Scheme::linearly_implicit, Scheme::exact};
    e.start = [setup](const Setting& setting) { return std::make_unique<DiscRun>(setup, setting); };
    e.reference = [setup, seconds](Method method, int refinement) {
        return reference_track(setup, seconds, method, refinement);
    };
    return e;
}

Surface paper_wall() {
    Surface s;
    s.stiffness = 15000.0;
    s.damping = 20.0;
    return s;
}

} // namespace

Experiment pulled_tool() {
    DiscSetup setup;
    setup.wall = false;
    setup.stiffness = Vec3(1577.0, 1577.0, 0.0);
    setup.damping = Vec3(30.45, 30.45, 0.0);
    setup.path = [](double t, Vec3& target, Vec3& velocity) {
        constexpr double k_reach = 0.01;
        const double w = 2.0 * std::numbers::pi * 3.0;
        target = Vec3(k_reach * (1.0 - std::cos(w * t)), k_radius + k_reach * std::sin(w * t), 0.0);
        velocity = Vec3(k_reach * w * std::sin(w * t), k_reach * w * std::cos(w * t), 0.0);
    };
    Experiment e = experiment_of(setup, 1.0);
    e.name = "pulled_tool";
    e.title =
        "A rigid tool of 0.3 kg in free space, pulled round a circle of 10 mm at 3 Hz by a hand of 1577 N/m.";
    e.smooth = true;
    e.methods = {Method::penalty};
    return e;
}

Experiment bouncing_tool() {
    DiscSetup setup;
    setup.surface = paper_wall();
    setup.surface.damping = 0.0;
    setup.surface.restitution = 0.7;
    setup.gap = 0.005;
    setup.gravity = Vec2(0.0, -9.81);
    Experiment e = experiment_of(setup, 0.4);
    e.name = "bouncing_tool";
    e.title = "A tool of 0.3 kg falls 5 mm on a wall of 15000 N/m without damper: springs alone lose "
              "nothing, impulses give back 0.7 "
              "of the speed (the paper's eq. (5) says the same of straight bounces).";
    e.methods = {Method::penalty, Method::impulse, Method::paper};
    return e;
}

Experiment pressing_tool() {
    DiscSetup setup;
    setup.surface = paper_wall();
    setup.gap = 0.002;
    setup.push = Vec2(0.0, -2.0);
    Experiment e = experiment_of(setup, 0.4);
    e.name = "pressing_tool";
    e.title = "A steady push of 2 N drives a tool of 0.3 kg over 2 mm into the paper's wall of 15000 N/m and "
              "20 N s/m.";
    e.methods = {Method::penalty, Method::impulse, Method::paper};
    return e;
}

Experiment sliding_tool() {
    DiscSetup setup;
    setup.surface = paper_wall();
    setup.surface.static_friction = 0.5;
    setup.surface.dynamic_friction = 0.3;
    setup.push = Vec2(0.0, -2.0);
    setup.gap = -2.0 / setup.surface.stiffness;
    setup.stiffness = Vec3(500.0, 0.0, 0.0);
    setup.damping = Vec3(5.0, 0.0, 0.0);
    setup.path = [](double t, Vec3& target, Vec3& velocity) {
        constexpr double k_reach = 0.01;
        const double w = 2.0 * std::numbers::pi;
        target = Vec3(k_reach * (1.0 - std::cos(w * t)), 0.0, 0.0);
        velocity = Vec3(k_reach * w * std::sin(w * t), 0.0, 0.0);
    };
    Experiment e = experiment_of(setup, 1.0);
    e.name = "sliding_tool";
    e.title = "A tool of 0.3 kg pressed with 2 N on the paper's wall and dragged 20 mm to and fro, friction "
              "0.5 at rest and "
              "0.3 in motion.";
    e.methods = {Method::penalty};
    return e;
}

} // namespace haptics::sweep
