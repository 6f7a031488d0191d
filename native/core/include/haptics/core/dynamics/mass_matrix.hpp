#pragma once
/// Mass matrix D(q) and bias forces C(q, q') q' + G(q) of D q'' + C + G = force. After update_positions().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// D, freedoms x freedoms.
void mass_matrix(const LinkageModel& model, const LinkageData& data, LinkageMatrix& mass);
/// C + G: the force that keeps all joint accelerations at zero. C is left out when model.coriolis is false.
void bias_forces(const LinkageModel& model, const LinkageData& data, LinkageVector& bias);
/// The same under `gravity` (m/s^2, scene axes) in place of the model's.
void bias_forces(const LinkageModel& model, const LinkageData& data, const Vec2& gravity,
                 LinkageVector& bias);
/// D a + C + G: the force that gives the joint accelerations `acceleration`.
void inverse_dynamics(const LinkageModel& model, const LinkageData& data, const LinkageVector& acceleration,
                      LinkageVector& force);

} // namespace haptics
