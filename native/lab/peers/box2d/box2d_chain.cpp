#include <haptics/peers/engines.hpp>

#include <box2d/box2d.h>

#include <cmath>

namespace haptics::peers {
namespace {

// Box2D is tuned for bodies of 0.1 to 10 units; a rod of 0.1 m is then 1 unit. Without gravity the motion
// does not depend on it.
constexpr double k_units_per_meter = 10.0;

float units(double meters) {
    return static_cast<float>(k_units_per_meter * meters);
}

class Box2dChain final : public ChainPeer {
  public:
    Box2dChain(const ChainPlan& plan, const Box2dIterations& iterations)
        : plan_(plan)
        , iterations_(iterations) {}

    void set_state(const double* position, const double* velocity) override {
        // a new world: the impulses that the old one would start from belong to another state
        world_ = std::make_unique<b2World>(b2Vec2(0.0F, 0.0F));
        world_->SetAllowSleeping(false);
        world_->SetContinuousPhysics(false);
        world_->SetWarmStarting(true);
        body_.clear();
        const b2BodyDef ground;
        b2Body* parent = world_->CreateBody(&ground);
        double x = 0.0;
        double y = 0.0;
        double angle = 0.0;
        double rate = 0.0;
        double velocity_x = 0.0;
        double velocity_y = 0.0;
        for (std::size_t i = 0; i < plan_.size(); ++i) {
            const ChainBody& link = plan_[i];
            // from the frame of the body before to the joint
            const double arm_x = std::cos(angle) * link.joint_x - std::sin(angle) * link.joint_y;
            const double arm_y = std::sin(angle) * link.joint_x + std::cos(angle) * link.joint_y;
            x += arm_x;
            y += arm_y;
            velocity_x -= rate * arm_y;
            velocity_y += rate * arm_x;
            angle += link.joint_angle + position[i];
            rate += velocity[i];
            const double center_x = std::cos(angle) * link.center_x - std::sin(angle) * link.center_y;
            const double center_y = std::sin(angle) * link.center_x + std::cos(angle) * link.center_y;

            b2BodyDef definition;
            definition.type = b2_dynamicBody;
            definition.allowSleep = false;
            definition.position.Set(units(x), units(y));
            definition.angle = static_cast<float>(angle);
            b2Body* body = world_->CreateBody(&definition);
            b2MassData mass;
            mass.mass = static_cast<float>(link.mass);
            mass.center.Set(units(link.center_x), units(link.center_y));
            // about the frame's origin, not the center
            mass.I = mass.mass * b2Dot(mass.center, mass.center) +
                     static_cast<float>(link.inertia * k_units_per_meter * k_units_per_meter);
            body->SetMassData(&mass);
            body->SetLinearVelocity(
                b2Vec2(units(velocity_x - rate * center_y), units(velocity_y + rate * center_x)));
            body->SetAngularVelocity(static_cast<float>(rate));

            b2RevoluteJointDef joint;
            joint.bodyA = parent;
            joint.bodyB = body;
            joint.localAnchorA.Set(units(link.joint_x), units(link.joint_y));
            joint.localAnchorB.SetZero();
            world_->CreateJoint(&joint);
            body_.push_back(body);
            parent = body;
        }
    }
    void get_state(double* position, double* velocity) const override {
        double angle = 0.0;
        double rate = 0.0;
        for (std::size_t i = 0; i < body_.size(); ++i) {
            const double own_angle = static_cast<double>(body_[i]->GetAngle());
            const double own_rate = static_cast<double>(body_[i]->GetAngularVelocity());
            position[i] = own_angle - angle - plan_[i].joint_angle;
            velocity[i] = own_rate - rate;
            angle = own_angle;
            rate = own_rate;
        }
    }
    bool acceleration(double* /*result*/) override { return false; }
    void step(double time_step) override {
        world_->Step(static_cast<float>(time_step), iterations_.velocity, iterations_.position);
    }

  private:
    ChainPlan plan_;
    Box2dIterations iterations_;
    std::unique_ptr<b2World> world_;
    std::vector<b2Body*> body_;
};

} // namespace

std::unique_ptr<ChainPeer> make_box2d_chain(const ChainPlan& plan, const Box2dIterations& iterations) {
    return std::make_unique<Box2dChain>(plan, iterations);
}

std::string box2d_version() {
    return std::to_string(b2_version.major) + "." + std::to_string(b2_version.minor) + "." +
           std::to_string(b2_version.revision);
}

} // namespace haptics::peers
