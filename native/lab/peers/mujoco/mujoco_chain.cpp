#include <haptics/peers/engines.hpp>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptics::peers {
namespace {

struct FreeSpec {
    void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
struct FreeModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
    void operator()(mjData* data) const { mj_deleteData(data); }
};

std::unique_ptr<mjModel, FreeModel> compile(const ChainPlan& plan, mjtIntegrator integrator) {
    const std::unique_ptr<mjSpec, FreeSpec> spec(mj_makeSpec());
    spec->option.integrator = integrator;
    // contacts, constraints, limits, springs, dampers, gravity, actuators, sensors, safety checks: all off
    spec->option.disableflags = (1 << mjNDISABLE) - 1;
    spec->option.enableflags = 0;
    mjsBody* parent = mjs_findBody(spec.get(), "world");
    for (const ChainBody& link : plan) {
        mjsBody* body = mjs_addBody(parent, nullptr);
        body->pos[0] = link.joint_x;
        body->pos[1] = link.joint_y;
        body->quat[0] = std::cos(0.5 * link.joint_angle);
        body->quat[3] = std::sin(0.5 * link.joint_angle);
        body->explicitinertial = 1;
        body->mass = link.mass;
        body->ipos[0] = link.center_x;
        body->ipos[1] = link.center_y;
        body->ipos[2] = 0.0;
        // only the last one takes part in the plane; equal ones form a possible body
        std::fill_n(body->inertia, 3, link.inertia);
        mjsJoint* joint = mjs_addJoint(body, nullptr);
        joint->type = mjJNT_HINGE;
        joint->axis[0] = 0.0;
        joint->axis[1] = 0.0;
        joint->axis[2] = 1.0;
        parent = body;
    }
    std::unique_ptr<mjModel, FreeModel> model(mj_compile(spec.get(), nullptr));
    if (!model)
        throw std::runtime_error(std::string("MuJoCo does not take the chain: ") + mjs_getError(spec.get()));
    return model;
}

class MujocoChain : public ChainPeer {
  public:
    explicit MujocoChain(const ChainPlan& plan, mjtIntegrator integrator = mjINT_EULER)
        : model_(compile(plan, integrator))
        , data_(mj_makeData(model_.get())) {}

    void set_state(const double* position, const double* velocity) override {
        mj_resetData(model_.get(), data_.get());
        std::copy_n(position, model_->nq, data_->qpos);
        std::copy_n(velocity, model_->nv, data_->qvel);
    }
    void get_state(double* position, double* velocity) const override {
        std::copy_n(data_->qpos, model_->nq, position);
        std::copy_n(data_->qvel, model_->nv, velocity);
    }
    bool acceleration(double* result) override {
        mj_forward(model_.get(), data_.get());
        std::copy_n(data_->qacc, model_->nv, result);
        return true;
    }
    void step(double time_step) override {
        model_->opt.timestep = time_step;
        mj_step(model_.get(), data_.get());
    }

  protected:
    [[nodiscard]] mjModel* model() { return model_.get(); }
    [[nodiscard]] mjData* data() { return data_.get(); }

  private:
    std::unique_ptr<mjModel, FreeModel> model_;
    std::unique_ptr<mjData, FreeData> data_;
};

class MujocoStages final : public MujocoChain {
  public:
    using MujocoChain::MujocoChain;

    bool acceleration(double* result) override {
        forward();
        std::copy_n(data()->qacc, model()->nv, result);
        return true;
    }
    void step(double time_step) override {
        forward();
        mjData* d = data();
        const auto size = model()->nv;
        for (decltype(model()->nv) i = 0; i < size; ++i) {
            d->qvel[i] += time_step * d->qacc[i];
            d->qpos[i] += time_step * d->qvel[i];
        }
    }

  private:
    void forward() {
        const mjModel* m = model();
        mjData* d = data();
        mj_kinematics(m, d);
        mj_comPos(m, d);
        mj_makeM(m, d);
        mj_factorM(m, d);
        mj_comVel(m, d);
        mj_rne(m, d, 0, d->qfrc_bias);
        const auto size = m->nv;
        for (decltype(m->nv) i = 0; i < size; ++i)
            d->qfrc_smooth[i] = -d->qfrc_bias[i];
        mj_solveM(m, d, d->qacc, d->qfrc_smooth, 1);
    }
};

} // namespace

std::unique_ptr<ChainPeer> make_mujoco_chain(const ChainPlan& plan) {
    return std::make_unique<MujocoChain>(plan);
}

std::unique_ptr<ChainPeer> make_mujoco_rk4_chain(const ChainPlan& plan) {
    return std::make_unique<MujocoChain>(plan, mjINT_RK4);
}

std::unique_ptr<ChainPeer> make_mujoco_stages_chain(const ChainPlan& plan) {
    return std::make_unique<MujocoStages>(plan);
}

std::string mujoco_version() {
    return mj_versionString();
}

} // namespace haptics::peers
