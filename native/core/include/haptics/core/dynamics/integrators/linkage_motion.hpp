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
        const int n = model_.freedoms;
        data_.position = y.head(n);
        data_.velocity = y.tail(n);
        force_ = constant_force;
        add_joint_forces(model_, data_, force_);
        prepare_dynamics(model_, data_);
        forward_dynamics(model_, data_, force_, factor_, acceleration_);
        rate.head(n) = y.tail(n);
        rate.tail(n) = acceleration_;
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
