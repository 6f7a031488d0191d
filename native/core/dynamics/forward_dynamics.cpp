#include <haptics/core/dynamics/closed_chain.hpp>
#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/split_chain.hpp>

namespace haptics {

void prepare_dynamics(const LinkageModel& model, LinkageData& data) {
    if (model.kernel == DynamicsKernel::rigid_body) {
        return;
    }
    update_rotations(model, data);
    if (model.kernel == DynamicsKernel::articulated) {
        update_positions(model, data);
    }
}

void forward_dynamics(const LinkageModel& model, const LinkageData& data, const JointVector& force,
                      ArticulatedFactor& workspace, JointVector& acceleration) {
    switch (model.kernel) {
    case DynamicsKernel::rigid_body: {
        // the base's frame sits at the center of mass: D is diagonal and constant
        acceleration.resize(3);
        const double inverse_mass = model.inverse_mass[1];
        acceleration[0] = force[0] * inverse_mass + model.gravity.x();
        acceleration[1] = force[1] * inverse_mass + model.gravity.y();
        acceleration[2] = force[2] * model.inverse_inertia[1];
        break;
    }
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

void step_semi_implicit(const LinkageModel& model, LinkageData& data, const JointVector& force, double dt,
                        ArticulatedFactor& workspace, JointVector& acceleration) {
    if (model.kernel == DynamicsKernel::closed_chain) {
        closed_chain_step(model, data, force, dt, acceleration);
        return;
    }
    prepare_dynamics(model, data);
    forward_dynamics(model, data, force, workspace, acceleration);
    double* q = data.position.data();
    double* v = data.velocity.data();
    const double* a = acceleration.data();
    for (int i = 0; i < model.freedoms; ++i) {
        v[i] += dt * a[i];
        q[i] += dt * v[i];
    }
}

} // namespace haptics
