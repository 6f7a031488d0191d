#pragma once
/// State of an ordinary differential equation y' = f(t, y), for the integrators of this folder.
///
/// A derivative is any callable `void(double t, const StateVector& y, StateVector& rate)`. It is called with
/// `rate` sized already. Nothing here allocates: the vectors have inline storage for the position and
/// velocity of the largest linkage.

#include <haptics/core/dynamics/linkage_model.hpp>

namespace haptics {

/// Most numbers in a state: positions and velocities.
inline constexpr int k_max_state = 2 * k_max_freedoms;

/// State, or its rate.
using StateVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_max_state, 1>;

} // namespace haptics
