#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/peers/peers.hpp>

#include <algorithm>
#include <stdexcept>

namespace haptics::peers {
namespace {

class OwnChain final : public ChainPeer {
  public:
    explicit OwnChain(const LinkageSpec& spec) {
        const std::vector<LinkageFault> faults = build_model(spec, model_);
        if (!faults.empty())
            throw std::invalid_argument("the chain is not a possible linkage");
        reset(model_, data_);
        force_.setZero(model_.freedoms);
        acceleration_.setZero(model_.freedoms);
    }
    void set_state(const double* position, const double* velocity) override {
        std::copy_n(position, model_.freedoms, data_.position.data());
        std::copy_n(velocity, model_.freedoms, data_.velocity.data());
    }
    void get_state(double* position, double* velocity) const override {
        std::copy_n(data_.position.data(), model_.freedoms, position);
        std::copy_n(data_.velocity.data(), model_.freedoms, velocity);
    }
    bool acceleration(double* result) override {
        prepare_dynamics(model_, data_);
        forward_dynamics(model_, data_, force_, factor_, acceleration_);
        std::copy_n(acceleration_.data(), model_.freedoms, result);
        return true;
    }
    void step(double time_step) override {
        step_semi_implicit(model_, data_, force_, time_step, factor_, acceleration_);
    }

  private:
    LinkageModel model_;
    LinkageData data_;
    ArticulatedFactor factor_;
    LinkageVector force_;
    LinkageVector acceleration_;
};

} // namespace

std::unique_ptr<ChainPeer> make_own_chain(const LinkageSpec& spec) {
    return std::make_unique<OwnChain>(spec);
}

ChainPlan plan_of(const LinkageSpec& spec) {
    if (spec.base != BaseKind::grounded || !spec.gravity.isZero(0.0) || !spec.coriolis)
        throw std::invalid_argument("a plan is of a grounded chain without gravity, with Coriolis terms");
    ChainPlan plan;
    for (const LinkSpec& link : spec.links) {
        const JointSpec& joint = link.joint;
        const bool passive = joint.damping != 0.0 || joint.friction != 0.0 || joint.spring_stiffness != 0.0 ||
                             joint.limit_stiffness != 0.0;
        if (link.parent != static_cast<int>(plan.size()) - 1 || joint.kind != JointKind::revolute || passive)
            throw std::invalid_argument("a plan is of a serial chain of revolute joints that move freely");
        plan.push_back({joint.frame.x(), joint.frame.y(), joint.frame.z(), link.mass, link.inertia,
                        link.center.x(), link.center.y()});
    }
    return plan;
}

} // namespace haptics::peers
