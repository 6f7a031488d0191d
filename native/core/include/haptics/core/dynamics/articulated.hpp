#pragma once
/// Articulated-body method: a factorization of D for any tree in O(n), forward dynamics, and D^-1 applied to
/// vectors and rows.

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// What the inward pass leaves for one body.
struct ArticulatedBody {
    /// Articulated inertia about the body's origin, scene axes: angular part, coupling, linear part
    /// (symmetric).
    double j{0.0}, hx{0.0}, hy{0.0}, mxx{0.0}, mxy{0.0}, myy{0.0};
    /// Bias force: torque about the origin and force.
    double torque{0.0}, fx{0.0}, fy{0.0};
    /// Articulated inertia times the joint's motion: torque and force. For the base: unused.
    double u{0.0}, ux{0.0}, uy{0.0};
    /// 1 / (motion^T inertia motion + added) and the joint's free force.
    double inverse{0.0}, free_force{0.0};
};

/// A factorization of D (plus an added diagonal) in the configuration it was made for.
struct ArticulatedFactor {
    Slots<ArticulatedBody, k_body_slots> body;
    /// Inverse of the floating base's articulated inertia: x, y, theta.
    Mat3 base_inverse{Mat3::Zero()};
};

/// Factorizes D, with `added` (may be null) on its diagonal. After update_positions().
void factorize(const LinkageModel& model, const LinkageData& data, const LinkageVector* added,
               ArticulatedFactor& factor);
/// factorize() and acceleration = D^-1 (force - C - G) in one sweep; `factor` can be used by solve()
/// afterwards.
void articulated_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                              const LinkageVector* added, ArticulatedFactor& factor,
                              LinkageVector& acceleration);
/// solution = D^-1 right_side in O(n). The two may be the same vector. `data` as it was when factorized.
void solve(const LinkageModel& model, const LinkageData& data, const ArticulatedFactor& factor,
           const LinkageVector& right_side, LinkageVector& solution);

} // namespace haptics
