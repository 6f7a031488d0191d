#include <haptics/peers/engines.hpp>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <stdexcept>

namespace haptics::peers {
namespace {

struct FreeBoxSpec {
    void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
struct FreeBoxModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeBoxData {
    void operator()(mjData* data) const { mj_deleteData(data); }
};

// boxes of one thickness in one plane
constexpr double k_half_thickness = 0.005;

void add_box(mjsBody* body, double x, double y, double half_x, double half_y, double time_constant) {
    mjsGeom* geom = mjs_addGeom(body, nullptr);
    geom->type = mjGEOM_BOX;
    geom->pos[0] = x;
    geom->pos[1] = y;
    geom->pos[2] = 0.0;
    geom->size[0] = half_x;
    geom->size[1] = half_y;
    geom->size[2] = k_half_thickness;
    geom->condim = 1;
    // the manual: no time constant below two steps
    geom->solref[0] = time_constant;
    geom->solref[1] = 1.0;
}

std::unique_ptr<mjModel, FreeBoxModel> compile_boxes(const BoxPlan& plan, double time_constant) {
    const std::unique_ptr<mjSpec, FreeBoxSpec> spec(mj_makeSpec());
    spec->option.integrator = mjINT_IMPLICITFAST;
    spec->option.timestep = plan.time_step;
    // contacts and their constraints stay on
    spec->option.disableflags =
        ((1 << mjNDISABLE) - 1) &
        ~(mjDSBL_CONSTRAINT | mjDSBL_CONTACT | mjDSBL_WARMSTART | mjDSBL_MIDPHASE | mjDSBL_FILTERPARENT);
    spec->option.enableflags = 0;
    mjsBody* world = mjs_findBody(spec.get(), "world");
    for (const FixedBox& box : plan.fixed)
        add_box(world, box.x, box.y, box.half_x, box.half_y, time_constant);
    mjsBody* body = mjs_addBody(world, nullptr);
    body->explicitinertial = 1;
    body->mass = plan.mass;
    std::fill_n(body->ipos, 3, 0.0);
    std::fill_n(body->inertia, 3, plan.inertia);
    for (int i = 0; i < 3; ++i) {
        mjsJoint* joint = mjs_addJoint(body, nullptr);
        joint->type = i < 2 ? mjJNT_SLIDE : mjJNT_HINGE;
        std::fill_n(joint->axis, 3, 0.0);
        joint->axis[i] = 1.0;
    }
    add_box(body, 0.0, 0.0, plan.half_x, plan.half_y, time_constant);
    std::unique_ptr<mjModel, FreeBoxModel> model(mj_compile(spec.get(), nullptr));
    if (!model)
        throw std::runtime_error(std::string("MuJoCo does not take the boxes: ") + mjs_getError(spec.get()));
    return model;
}

class MujocoBox final : public BoxPeer {
  public:
    MujocoBox(const BoxPlan& plan, double time_constant)
        : model_(compile_boxes(plan, time_constant))
        , data_(mj_makeData(model_.get())) {
        std::copy_n(plan.start, 3, data_->qpos);
        mj_forward(model_.get(), data_.get());
    }
    void state(double* pose, double* velocity) const override {
        std::copy_n(data_->qpos, 3, pose);
        std::copy_n(data_->qvel, 3, velocity);
    }
    void step(const double* force) override {
        std::copy_n(force, 3, data_->qfrc_applied);
        mj_step(model_.get(), data_.get());
    }

  private:
    std::unique_ptr<mjModel, FreeBoxModel> model_;
    std::unique_ptr<mjData, FreeBoxData> data_;
};

} // namespace

std::unique_ptr<BoxPeer> make_mujoco_box(const BoxPlan& plan) {
    return std::make_unique<MujocoBox>(plan, 0.02);
}

std::unique_ptr<BoxPeer> make_mujoco_stiff_box(const BoxPlan& plan) {
    return std::make_unique<MujocoBox>(plan, 2.0 * plan.time_step);
}

} // namespace haptics::peers
