// A library of its own, compiled for this very machine and hiding all but its two functions: Pinocchio is
// templates, and the same Eigen templates compiled under other flags elsewhere must not meet these.

#include <haptics/peers/engines.hpp>

#include <algorithm>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

namespace haptics::peers {
namespace {

pinocchio::Model build(const ChainPlan& plan) {
    pinocchio::Model model;
    model.gravity.setZero();
    pinocchio::JointIndex parent = 0;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const ChainBody& link = plan[i];
        const pinocchio::SE3 place(
            Eigen::AngleAxisd(link.joint_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
            Eigen::Vector3d(link.joint_x, link.joint_y, 0.0));
        parent = model.addJoint(parent, pinocchio::JointModelRZ(), place, "joint" + std::to_string(i));
        // only the inertia about z takes part in the plane; equal ones form a possible body
        const Eigen::Matrix3d inertia = link.inertia * Eigen::Matrix3d::Identity();
        model.appendBodyToJoint(
            parent,
            pinocchio::Inertia(link.mass, Eigen::Vector3d(link.center_x, link.center_y, 0.0), inertia),
            pinocchio::SE3::Identity());
    }
    return model;
}

class PinocchioChain : public ChainPeer {
  public:
    explicit PinocchioChain(const ChainPlan& plan)
        : model_(build(plan))
        , data_(model_)
        , position_(Eigen::VectorXd::Zero(model_.nq))
        , velocity_(Eigen::VectorXd::Zero(model_.nv))
        , force_(Eigen::VectorXd::Zero(model_.nv)) {}

    void set_state(const double* position, const double* velocity) override {
        std::copy_n(position, model_.nq, position_.data());
        std::copy_n(velocity, model_.nv, velocity_.data());
    }
    void get_state(double* position, double* velocity) const override {
        std::copy_n(position_.data(), model_.nq, position);
        std::copy_n(velocity_.data(), model_.nv, velocity);
    }
    bool acceleration(double* result) override {
        pinocchio::aba(model_, data_, position_, velocity_, force_, pinocchio::Convention::WORLD);
        std::copy_n(data_.ddq.data(), model_.nv, result);
        return true;
    }
    void step(double time_step) override {
        pinocchio::aba(model_, data_, position_, velocity_, force_, pinocchio::Convention::WORLD);
        // joints about z have one angle each: adding is integrating
        velocity_ += time_step * data_.ddq;
        position_ += time_step * velocity_;
    }

  protected:
    pinocchio::Model model_;
    pinocchio::Data data_;
    Eigen::VectorXd position_;
    Eigen::VectorXd velocity_;
    Eigen::VectorXd force_;
};

class PinocchioRk4Chain final : public PinocchioChain {
  public:
    explicit PinocchioRk4Chain(const ChainPlan& plan)
        : PinocchioChain(plan) {
        for (Eigen::VectorXd* stage : {&stage_, &speed_, &speed_sum_, &rate_sum_})
            stage->setZero(model_.nv);
    }
    void step(double time_step) override {
        constexpr double k_weight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
        constexpr double k_next[] = {0.5, 0.5, 1.0, 0.0};
        stage_ = position_;
        speed_ = velocity_;
        speed_sum_.setZero();
        rate_sum_.setZero();
        for (int i = 0; i < 4; ++i) {
            pinocchio::aba(model_, data_, stage_, speed_, force_, pinocchio::Convention::WORLD);
            speed_sum_ += k_weight[i] * speed_;
            rate_sum_ += k_weight[i] * data_.ddq;
            stage_ = position_ + k_next[i] * time_step * speed_;
            speed_ = velocity_ + k_next[i] * time_step * data_.ddq;
        }
        position_ += time_step * speed_sum_;
        velocity_ += time_step * rate_sum_;
    }

  private:
    Eigen::VectorXd stage_;
    Eigen::VectorXd speed_;
    Eigen::VectorXd speed_sum_;
    Eigen::VectorXd rate_sum_;
};

} // namespace

std::unique_ptr<ChainPeer> make_pinocchio_chain(const ChainPlan& plan) {
    return std::make_unique<PinocchioChain>(plan);
}

std::unique_ptr<ChainPeer> make_pinocchio_rk4_chain(const ChainPlan& plan) {
    return std::make_unique<PinocchioRk4Chain>(plan);
}

std::string pinocchio_version() {
    return PINOCCHIO_VERSION;
}

} // namespace haptics::peers
