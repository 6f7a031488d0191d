#pragma once
/// Simultaneous collisions (section 3.2 of Constantinescu, Salcudean and Croft 2003, eqs 4 to 6): one set of
/// impulses that resolves all closing contacts at once. The derivation is in
/// native/core/contact/collision.cpp.
///
///     problem.resize(freedoms, contacts);
///     problem.inverse_mass = …;              // D^-1
///     problem.normal_rows.row(i) = …;        // and the other per-contact members
///     problem.velocity = …;                  // q' before
///     resolve_collisions(CollisionMethod::poisson, problem, workspace, solution);
///     velocity = solution.velocity;          // q' after

#include <haptics/core/types.hpp>

#include <cstdint>

namespace haptics {

/// How colliding contacts are resolved.
enum class CollisionMethod : std::uint8_t {
    /// Default. Poisson's hypothesis in two phases (compression, restitution) with Coulomb friction: impulses
    /// never pull, kinetic energy never grows, sliding survives.
    poisson,
    /// v+ = -e v- for every closing contact, as an equality in the metric of D (least squares of the smallest
    /// change of motion). Without friction. Can pull; can add energy when restitutions differ.
    mass_weighted,
    /// Eq. (5) by pseudo-inverse. Without friction. Stops free motion, can add energy and pull. For
    /// comparison only.
    paper,
};

/// Most contacts of one collision problem.
inline constexpr int k_max_collision_contacts = 64;
/// Most freedoms of one collision problem: a linkage of 66 and 16 movable bodies of 3.
inline constexpr int k_max_collision_freedoms = 114;
/// Most contacts with friction that the exact friction solver takes on at once; more go to the fallback.
inline constexpr int k_max_exact_friction_contacts = 16;

/// One value per contact, capacity fixed: resizing never allocates.
using ContactVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_max_collision_contacts, 1>;
/// One value per freedom, capacity fixed.
using FreedomVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_max_collision_freedoms, 1>;
/// One row of freedoms per contact, row by row in memory, capacity fixed.
using ContactRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                                  k_max_collision_contacts, k_max_collision_freedoms>;
/// Square matrix over the freedoms, row by row in memory, capacity fixed.
using FreedomMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                                    k_max_collision_freedoms, k_max_collision_freedoms>;

/// One collision problem in configuration space. About 230 kB: keep it with the stepping data, not on the
/// stack.
struct CollisionProblem {
    /// D^-1, freedoms x freedoms, symmetric positive definite (block diagonal for an island of several
    /// bodies).
    FreedomMatrix inverse_mass;
    /// q' before the collision.
    FreedomVector velocity;
    /// Normal rows J_n, contacts x freedoms: the gap opens at J_n q' - wall_normal_velocity, m/s. A contact
    /// that cannot be moved gets no impulse: a row of zeros, one below 1e-7 of the largest in the metric of
    /// D^-1, and, where walls move, one below 1e-3 of its own tangent (a nearly stretched arm pushed along).
    ContactRows normal_rows;
    /// Tangent rows J_t, contacts x freedoms: the contact slips at J_t q' - wall_tangent_velocity, m/s.
    ContactRows tangent_rows;
    /// Velocity of the environment's side along the normal, m/s, positive towards the tool.
    ContactVector wall_normal_velocity;
    /// Velocity of the environment's side along the tangent, m/s.
    ContactVector wall_tangent_velocity;
    /// Poisson's coefficient of restitution, 0..1 (values outside are clamped).
    ContactVector restitution;
    /// Coulomb coefficient, >= 0.
    ContactVector friction;

    /// Sets the sizes without allocating; walls at rest, no restitution, no friction, all else to be filled
    /// in. freedoms 1..k_max_collision_freedoms, contacts 0..k_max_collision_contacts (clamped).
    void resize(int freedoms, int contacts);
    [[nodiscard]] int freedoms() const { return static_cast<int>(velocity.size()); }
    [[nodiscard]] int contacts() const { return static_cast<int>(restitution.size()); }
};

/// What a collision did.
struct CollisionSolution {
    /// q' after the collision.
    FreedomVector velocity;
    /// P_cs of eq. (6), D (q'+ - q'-); J_n^T p_n + J_t^T p_t for `poisson` and `mass_weighted`.
    FreedomVector momentum_change;
    /// Normal impulse per contact, N s, >= 0 for `poisson`. For `paper`, whose change of momentum is in
    /// general no sum of contact impulses, the smallest that give the same change of normal velocities.
    ContactVector normal_impulse;
    /// Tangential impulse per contact, N s, along +tangent, at most friction times normal_impulse.
    ContactVector tangent_impulse;
    /// Kinetic energy gained minus the work of moving walls, J: the sum of p (v- + v+)/2 over all contacts.
    /// Never positive for `poisson` (but for rounding); with walls at rest it is the change of kinetic
    /// energy.
    double energy_change{0.0};
    /// Share of the restitution impulses that was applied, 0..1; below 1 only where all of them would have
    /// added energy (unequal restitutions, or friction coupled with the normals).
    double restitution_scale{1.0};
    /// Pivots and active-set changes, all phases.
    int iterations{0};
    /// Contacts left without impulse because no motion can satisfy them, or only one that takes 1000 times
    /// the impulse of the fastest contact alone (squeezed between closing walls, a narrow closing wedge).
    /// Never with walls at rest.
    int squeezed{0};
    /// No exact solution was found within the bound, or none exists (jammed by friction between moving
    /// walls); the guaranteed but approximate method gave the answer.
    bool fell_back{false};
};

/// Scratch memory of resolve_collisions, about 750 kB, no state between calls. One per thread.
struct CollisionWorkspace {
    static constexpr int k_rows = 2 * k_max_collision_contacts;
    static constexpr int k_complementarity = 4 * k_max_exact_friction_contacts + k_max_collision_contacts;

    /// J, rows x freedoms: normals, then the tangents of contacts with friction; all scaled per contact.
    double jacobian[k_rows * k_max_collision_freedoms];
    /// J D^-1.
    double response[k_rows * k_max_collision_freedoms];
    /// J D^-1 J^T.
    double delassus[k_rows * k_rows];
    /// L of D^-1 = L L^T, and the normals times L.
    double mass_factor[k_max_collision_freedoms * k_max_collision_freedoms];
    double whitened[k_max_collision_contacts * k_max_collision_freedoms];
    /// Orthonormal axes and triangular factor of the active normals; singular vectors of the comparison
    /// methods.
    double axes[k_max_collision_contacts * k_max_collision_freedoms];
    double factor[k_max_collision_contacts * k_max_collision_contacts];
    /// Tableau of the complementarity problem with friction.
    double tableau[k_complementarity * (k_complementarity + 2)];
};

/// Resolves all collisions of `problem`. Always gives a solution; deterministic; neither allocates nor
/// throws. All iterations are bounded: the slowest of the benchmarks, collision/hard, shows what the bound
/// amounts to.
void resolve_collisions(CollisionMethod method, const CollisionProblem& problem,
                        CollisionWorkspace& workspace, CollisionSolution& solution) noexcept;

} // namespace haptics
