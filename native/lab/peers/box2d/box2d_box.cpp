#include <haptics/peers/engines.hpp>

#include <box2d/box2d.h>

namespace haptics::peers {
namespace {

class Box2dBox final : public BoxPeer {
  public:
    Box2dBox(const BoxPlan& plan, double units_per_meter)
        : scale_(units_per_meter)
        , step_(static_cast<float>(plan.time_step)) {
        world_.SetAllowSleeping(false);
        world_.SetWarmStarting(true);
        const b2BodyDef ground;
        b2Body* fixed = world_.CreateBody(&ground);
        for (const FixedBox& box : plan.fixed) {
            b2PolygonShape shape;
            shape.SetAsBox(units(box.half_x), units(box.half_y), b2Vec2(units(box.x), units(box.y)), 0.0F);
            b2FixtureDef fixture;
            fixture.shape = &shape;
            fixture.friction = 0.0F;
            fixed->CreateFixture(&fixture);
        }
        b2BodyDef definition;
        definition.type = b2_dynamicBody;
        definition.allowSleep = false;
        // small gaps at speed: its own continuous collision
        definition.bullet = true;
        definition.position.Set(units(plan.start[0]), units(plan.start[1]));
        definition.angle = static_cast<float>(plan.start[2]);
        body_ = world_.CreateBody(&definition);
        b2PolygonShape shape;
        shape.SetAsBox(units(plan.half_x), units(plan.half_y));
        b2FixtureDef fixture;
        fixture.shape = &shape;
        fixture.friction = 0.0F;
        fixture.restitution = 0.0F;
        fixture.density = 1.0F;
        body_->CreateFixture(&fixture);
        b2MassData mass;
        mass.mass = static_cast<float>(plan.mass);
        mass.center.SetZero();
        mass.I = static_cast<float>(plan.inertia * scale_ * scale_);
        body_->SetMassData(&mass);
    }
    void state(double* pose, double* velocity) const override {
        pose[0] = static_cast<double>(body_->GetPosition().x) / scale_;
        pose[1] = static_cast<double>(body_->GetPosition().y) / scale_;
        pose[2] = static_cast<double>(body_->GetAngle());
        velocity[0] = static_cast<double>(body_->GetLinearVelocity().x) / scale_;
        velocity[1] = static_cast<double>(body_->GetLinearVelocity().y) / scale_;
        velocity[2] = static_cast<double>(body_->GetAngularVelocity());
    }
    void step(const double* force) override {
        body_->ApplyForceToCenter(b2Vec2(units(force[0]), units(force[1])), true);
        body_->ApplyTorque(static_cast<float>(force[2] * scale_ * scale_), true);
        // as Box2D's manual suggests
        world_.Step(step_, 8, 3);
    }

  private:
    [[nodiscard]] float units(double meters) const { return static_cast<float>(scale_ * meters); }
    double scale_;
    float step_;
    b2World world_{b2Vec2(0.0F, 0.0F)};
    b2Body* body_;
};

} // namespace

std::unique_ptr<BoxPeer> make_box2d_box(const BoxPlan& plan) {
    return std::make_unique<Box2dBox>(plan, 100.0);
}

std::unique_ptr<BoxPeer> make_box2d_fine_box(const BoxPlan& plan) {
    return std::make_unique<Box2dBox>(plan, 1000.0);
}

} // namespace haptics::peers
