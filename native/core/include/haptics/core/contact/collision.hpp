#pragma once
/// Simultaneous collisions (section 3.2 of the paper, eqs 4 to 6): impulses that resolve all closing contacts at once.

#include <haptics/core/types.hpp>

#include <cstdint>

namespace haptics {

/// How colliding contacts are resolved.
enum class CollisionMethod : std::uint8_t {
    poisson,       ///< default: two phases (compression, restitution), impulses >= 0, kinetic energy never grows
    mass_weighted, ///< v+ = -e v- as an equality in the metric of D; can pull
    paper,         ///< eq. (5) by pseudo-inverse; can add energy, stops free motion
};

/// Most rows and freedoms of one collision problem.
inline constexpr int k_max_collision_contacts = 64;

/// One collision problem in configuration space. n freedoms, m contacts.
struct CollisionProblem {
    int freedoms{0};
    int contacts{0};
    /// D^-1, n x n, symmetric positive definite.
    Eigen::Ref<const Eigen::MatrixXd> inverse_mass;
    /// Normal rows J_n, m x n: relative normal velocity = J_n q' - wall_velocity, positive when opening.
    Eigen::Ref<const Eigen::MatrixXd> normal_rows;
    /// Tangent rows J_t, m x n.
    Eigen::Ref<const Eigen::MatrixXd> tangent_rows;
    /// Normal and tangential velocity of the environment side at each contact, m/s (moving walls).
    Eigen::Ref<const Eigen::VectorXd> wall_normal_velocity;
    Eigen::Ref<const Eigen::VectorXd> wall_tangent_velocity;
    /// Restitution 0..1 and friction coefficient >= 0 of each contact.
    Eigen::Ref<const Eigen::VectorXd> restitution;
    Eigen::Ref<const Eigen::VectorXd> friction;
};

/// Result flags.
struct CollisionResult {
    /// The iteration reached its bound and the deterministic fallback gave the answer.
    bool fell_back{false};
    /// Iterations used.
    int iterations{0};
};

} // namespace haptics
