#include <haptics/core/dynamics/closed_chain.hpp>
#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/split_chain.hpp>

namespace haptics {

namespace {

/// The base's frame sits at the center of mass: D is diagonal and constant.
inline void rigid_acceleration(const LinkageModel& model, const double* force, double* acceleration) {
    acceleration[0] = force[0] * model.inverse_mass[1] + model.gravity.x();
    acceleration[1] = force[1] * model.inverse_mass[1] + model.gravity.y();
    acceleration[2] = force[2] * model.inverse_inertia[1];
}

} // namespace

void prepare_dynamics(const LinkageModel& model, LinkageData& data) {
    if (model.kernel == DynamicsKernel::rigid_body) {
        return;
    }
    update_rotations(model, data);
    if (model.kernel == DynamicsKernel::articulated) {
        update_positions(model, data);
    }
}

void forward_dynamics(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                      ArticulatedFactor& workspace, LinkageVector& acceleration) {
    switch (model.kernel) {
    case DynamicsKernel::rigid_body:
        acceleration.resize(3);
        rigid_acceleration(model, force.data(), acceleration.data());
        break;
    case DynamicsKernel::closed_chain:
        closed_chain_acceleration(model, data, force, acceleration);
        break;
    case DynamicsKernel::split_chain:
        split_chain_acceleration(model, data, force, acceleration);
        break;
    case DynamicsKernel::articulated:
        articulated_acceleration(model, data, force, nullptr, workspace, acceleration);
        break;
    }
}

void step_semi_implicit(const LinkageModel& model, LinkageData& data, const LinkageVector& force, double dt,
                        ArticulatedFactor& workspace, LinkageVector& acceleration) {
    if (model.kernel == DynamicsKernel::closed_chain) {
        closed_chain_step(model, data, force, dt, acceleration);
        return;
    }
    double* q = data.position.data();
    double* v = data.velocity.data();
    if (model.kernel == DynamicsKernel::rigid_body) {
        double a[3];
        rigid_acceleration(model, force.data(), a);
        acceleration.resize(3);
        for (int i = 0; i < 3; ++i) {
            acceleration[i] = a[i];
            v[i] += dt * a[i];
            q[i] += dt * v[i];
        }
        return;
    }
    prepare_dynamics(model, data);
    forward_dynamics(model, data, force, workspace, acceleration);
    const double* a = acceleration.data();
    for (int i = 0; i < model.freedoms; ++i) {
        v[i] += dt * a[i];
        q[i] += dt * v[i];
    }
}

} // namespace haptics
