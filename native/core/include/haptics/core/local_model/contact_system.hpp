#pragma once
/// The contacts of one step as rows in configuration space. Memory of the step, part of Data; not for users.

#include <haptics/core/contact/collision.hpp>
#include <haptics/core/contact/contact.hpp>
#include <haptics/core/local_model/movable.hpp>
#include <haptics/core/types.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// Freedoms of the tool and its movable neighbors.
inline constexpr int k_max_island_freedoms = 3 + 3 * k_max_movables;
/// Contact points of one step.
inline constexpr int k_max_points = 2 * k_max_patches;

using PointRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, k_max_points,
                                k_max_island_freedoms>;
using PatchRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, k_max_patches,
                                k_max_island_freedoms>;

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
};

/// One tangent row and the friction spring behind it.
struct PatchRow {
    std::int32_t patch{0};
    std::int32_t first_point{0};
    std::int32_t point_count{0};
    double stiffness{0.0};
    double damping{0.0};
    double static_friction{0.0};
    double dynamic_friction{0.0};
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
    /// Tool on one side and this movable on the other (index in Data::movable); -1 otherwise.
    std::int32_t movable{-1};
};

struct ContactSystem {
    int freedoms{3};
    int points{0};
    int patches{0};
    FreedomVector velocity;
    FreedomVector external; ///< generalized force that is not contact nor coupling
    FreedomMatrix mass;
    FreedomMatrix inverse_mass;
    PointRows normal_rows;
    PatchRows tangent_rows;
    std::array<PointRow, k_max_points> point;
    std::array<PatchRow, k_max_patches> row;
};

} // namespace haptics
