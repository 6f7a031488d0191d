#pragma once
/// A linkage as an ordinary differential equation for the integrators: y = (q, q').

#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/integrators/state_vector.hpp>
#include <haptics/core/dynamics/joint_forces.hpp>

namespace haptics {

/// y' of a linkage under a constant generalized force and its passive joint forces. Holds references: model
/// and data outlive it. Pass it to an integrator by reference (it carries the memory of the articulated
/// method).
class LinkageMotion {
  public:
    LinkageMotion(const LinkageModel& model, LinkageData& data)
        : model_(model)
        , data_(data) {
        constant_force.setZero(model.freedoms);
    }

    /// Writes the rate of y; leaves y's state in the data.
    void operator()(double /*t*/, const StateVector& y, StateVector& rate) const {
        // few numbers: plain loops beat vector expressions of a size that is not known
        const int n = model_.freedoms;
        force_.resize(n);
        for (int i = 0; i < n; ++i) {
            data_.position[i] = y[i];
            data_.velocity[i] = y[n + i];
            force_[i] = constant_force[i];
        }
        add_joint_forces(model_, data_, force_);
        prepare_dynamics(model_, data_);
        forward_dynamics(model_, data_, force_, factor_, acceleration_);
        for (int i = 0; i < n; ++i) {
            rate[i] = y[n + i];
            rate[n + i] = acceleration_[i];
        }
    }

    /// Generalized force that does not change, N m or N.
    LinkageVector constant_force;

  private:
    const LinkageModel& model_;
    LinkageData& data_;
    mutable ArticulatedFactor factor_;
    mutable LinkageVector force_, acceleration_;
};

} // namespace haptics
