#pragma once
/// Mass matrix D(q) and bias forces C(q, q') q' + G(q) of D q'' + C + G = force. After update_positions().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// D, freedoms x freedoms.
void mass_matrix(const LinkageModel& model, const LinkageData& data, JointMatrix& mass);
/// C + G: the force that keeps all joint accelerations at zero. C is left out when model.coriolis is false.
void bias_forces(const LinkageModel& model, const LinkageData& data, JointVector& bias);
/// D a + C + G: the force that gives the joint accelerations `acceleration`.
void inverse_dynamics(const LinkageModel& model, const LinkageData& data, const JointVector& acceleration,
                      JointVector& force);

} // namespace haptics
