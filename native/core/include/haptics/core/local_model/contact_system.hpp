#pragma once
/// The contacts of one step as rows in configuration space. Memory of the step, part of Data; not for users.

#include <haptics/core/contact/collision.hpp>
#include <haptics/core/contact/contact.hpp>
#include <haptics/core/dynamics/articulated.hpp>
#include <haptics/core/dynamics/jacobian.hpp>
#include <haptics/core/local_model/movable.hpp>
#include <haptics/core/local_model/row_store.hpp>
#include <haptics/core/types.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// Freedoms of the tool and its movable neighbors.
inline constexpr int k_max_island_freedoms = k_max_freedoms + 3 * k_max_movables;
static_assert(k_max_island_freedoms == k_max_collision_freedoms);
/// Rows with friction of one step: the patches, and limits and friction of the tool's joints.
inline constexpr int k_max_rows = k_max_patches + 2 * k_max_freedoms;
/// Normal rows of one step: the points of the patches, and the joint limits.
inline constexpr int k_max_points = 2 * k_max_patches + k_max_freedoms;

using PointRows = RowStore<k_max_points>;
using PatchRows = RowStore<k_max_rows>;

/// J_h, 3 x freedoms of the tool.
using GripRows = PointJacobian;

/// Friction of a patch during one solve.
enum class FrictionMode : std::int8_t { off, stick, slip_forward, slip_backward };

/// One normal row and the spring-damper behind it.
struct PointRow {
    std::int32_t patch{0};
    /// Index of the point in its patch.
    std::int32_t slot{0};
    double gap{0.0};
    /// Share of the patch's stiffness and damping.
    double stiffness{0.0};
    double damping{0.0};
    /// Normal velocity of the side that is not in the system, m/s: gap rate = row v - drive.
    double drive{0.0};
    /// Result: normal force, N, >= 0, mean of the last sub-step.
    double force{0.0};
    bool active{false};
    /// The point was apart when the step began, so that closing it is a hit.
    bool was_apart{false};
    /// Impulse of `force` since the step began, N s (exact integrator).
    double impulse{0.0};
};

/// One tangent row and the friction spring behind it: of a patch, or of a joint.
struct PatchRow {
    /// Index in Data::patches; -1 for a joint of the tool.
    std::int32_t patch{-1};
    /// The tool's freedom whose limit (a point) or friction (no point) this is; -1 for a patch.
    std::int32_t freedom{-1};
    std::int32_t first_point{0};
    std::int32_t point_count{0};
    double stiffness{0.0};
    double damping{0.0};
    double static_friction{0.0};
    double dynamic_friction{0.0};
    /// Friction that no normal force causes (of a joint), N or N m.
    double bound{0.0};
    double restitution{0.0};
    double drive{0.0};
    /// Displacement of the friction spring from its anchor, m.
    double spring{0.0};
    double force{0.0};
    FrictionMode mode{FrictionMode::off};
    /// The patch was in continuous contact when the step began.
    bool continuing{false};
    /// The patch was sliding when the step began (dynamic friction bounds it).
    bool was_sliding{false};
    bool collided{false};
    /// Normal impulse of this step's collisions, N s.
    double impulse{0.0};
    /// Impulse of `force` since the step began, N s (exact integrator).
    double tangent_impulse{0.0};
    /// Work that the movable on the other side did on the tool in the last sub-step, J (exact integrator).
    double movable_work{0.0};
    /// Tool on one side and this movable on the other (index in Data::movable); -1 otherwise.
    std::int32_t movable{-1};
};

/// Most rows that the row solver of long linkages takes on, those of the grip included.
inline constexpr int k_most_solver_rows = 51;
using SolverRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, k_most_solver_rows,
                                 k_most_solver_rows>;
using SolverVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_most_solver_rows, 1>;
using SolverColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                    k_max_island_freedoms, k_most_solver_rows>;

/// Memory of the row solver: rows of the grip, the points and the patches, in this order.
struct RowSystem {
    /// With the joints' springs on its diagonal.
    ArticulatedFactor factor;
    LinkageVector added;
    /// Velocity without any row's force.
    FreedomVector free;
    /// R', A0^-1 R', R A0^-1 R'.
    SolverColumns row;
    SolverColumns response;
    SolverRows mobility;
    SolverRows work;
    /// R v without any row's force; force = push - stiffness * rate.
    SolverVector rate;
    SolverVector stiffness;
    SolverVector push;
    SolverVector force;
};

struct ContactSystem {
    /// Of the tool, which come first, and of the tool and its movable neighbors.
    int tool_freedoms{3};
    int freedoms{3};
    int points{0};
    int patches{0};
    FreedomVector velocity;
    FreedomVector external; ///< generalized force that is not contact nor coupling
    /// A joint of the tool has a spring or a damper.
    bool has_joint_springs{false};
    /// D, its inverse and C + G of a linkage.
    LinkageMatrix tool_mass;
    LinkageMatrix tool_inverse;
    LinkageVector bias;
    /// J_h of the present grip (the third row is zero for a point grip).
    GripRows grip;
    GripRows weighted_grip;
    /// Matrices of the solvers, for systems of more than a few freedoms.
    FreedomMatrix base;
    FreedomMatrix work;
    RowSystem rows;
    /// All forces on the tool but those of the hand; gravity's part of `external`.
    LinkageVector tool_force;
    /// What the coordinates of a linkage changed by since the step began.
    LinkageVector displacement;
    /// A linkage's D and J are those of so much later than the start of the step, s (exact integrator).
    double ahead{0.0};
    /// Coordinates and velocity of a linkage when the step began, and what collisions changed it by since.
    LinkageVector start_position;
    LinkageVector start_velocity;
    /// Work of all forces but Coriolis and collisions since the step began, J.
    double force_work{0.0};
    LinkageVector jump;
    LinkageVector tool_weight;
    /// `mass` and `inverse_mass` hold the tool's part (a long linkage has them only when asked for).
    bool has_mass{false};
    bool has_inverse{false};
    FreedomMatrix mass;
    FreedomMatrix inverse_mass;
    PointRows normal_rows;
    PatchRows tangent_rows;
    std::array<PointRow, k_max_points> point;
    std::array<PatchRow, k_max_rows> row;
};

} // namespace haptics
