// Our local model on the scene of box_peer.hpp: springs of 1e7 N/m and 20 N s/m.

#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/peers/engines.hpp>

namespace haptics::peers {
namespace {

template <Integrator kind>
class OwnBox final : public BoxPeer {
  public:
    explicit OwnBox(const BoxPlan& plan)
        : step_(plan.time_step) {
        ToolModel& tool = model_.tool;
        tool.mass = plan.mass;
        tool.inertia = plan.inertia;
        tool.shape.body_count = tool.shape.piece_count = 1;
        tool.shape.body[0].kind = BodyKind::tool;
        tool.shape.body[0].surface = neutral_surface();
        tool.shape.body[0].piece_count = 1;
        tool.shape.piece[0].id = 1;
        tool.shape.piece[0].convex = make_box(Vec2::Zero(), 2.0 * Vec2(plan.half_x, plan.half_y));
        model_.settings.integrator = kind;
        const auto scene = std::make_unique<Neighborhood>();
        scene->sequence = 1;
        BodySet& bodies = scene->bodies;
        for (const FixedBox& box : plan.fixed) {
            const auto place = static_cast<std::size_t>(bodies.body_count);
            Body& body = bodies.body[place];
            body.id = place + 1;
            body.surface.stiffness = 1e7;
            body.surface.damping = 20.0;
            body.first_piece = bodies.piece_count;
            body.piece_count = 1;
            bodies.piece[place].id = static_cast<std::uint32_t>(place + 1);
            bodies.piece[place].convex = make_box(Vec2(box.x, box.y), 2.0 * Vec2(box.half_x, box.half_y));
            ++bodies.body_count;
            ++bodies.piece_count;
        }
        reset(model_, *data_, Pose(plan.start[0], plan.start[1], plan.start[2]));
        scene->plan = choose_plan(model_, *scene);
        take_neighborhood(*scene, *data_);
        hand_.held = true;
    }
    void state(double* pose, double* velocity) const override {
        for (int i = 0; i < 3; ++i) {
            pose[i] = data_->pose[i];
            velocity[i] = data_->velocity[i];
        }
    }
    void step(const double* force) override {
        hand_.force = Wrench(force[0], force[1], force[2]);
        haptics::step(model_, *data_, hand_, step_, out_);
    }

  private:
    Model model_;
    std::unique_ptr<Data> data_{std::make_unique<Data>()};
    HandInput hand_;
    StepOutput out_;
    double step_;
};

} // namespace

std::unique_ptr<BoxPeer> make_own_box(const BoxPlan& plan) {
    return std::make_unique<OwnBox<Integrator::linearly_implicit>>(plan);
}

std::unique_ptr<BoxPeer> make_own_exact_box(const BoxPlan& plan) {
    return std::make_unique<OwnBox<Integrator::exact>>(plan);
}

} // namespace haptics::peers
