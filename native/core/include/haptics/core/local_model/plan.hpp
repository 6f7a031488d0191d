#pragma once
/// What a haptic step does for a given scene, and why it leaves out the rest.
///
/// A plan is chosen off the loop from the tool, the method and a snapshot, travels with that snapshot and
/// takes effect with it, between two steps. A stage is left out only where it would have done nothing: the
/// motion is the same to the last bit. Plan{} leaves out nothing.

#include <cstdint>
#include <string_view>
#include <vector>

namespace haptics {

struct Model;
struct Neighborhood;

/// Stages of a step that a scene may not need.
enum class Stage : std::uint8_t {
    detection,      ///< finding contacts
    moving_walls,   ///< extrapolating and blending what the scene moves, and its speed in contacts
    movables,       ///< neighbors with mass: island, beliefs, corrections
    collisions,     ///< times of impact and collision impulses
    restitution,    ///< the second phase of collisions
    friction,       ///< tangent rows, stick and slip
    gravity,        ///< weights
    linkage,        ///< kinematics and mass matrix of a linkage
    coriolis,       ///< velocity terms of a linkage
    joint_limits,   ///< limit rows
    joint_friction, ///< friction rows of joints
    joint_springs,  ///< springs and dampers of joints
    free_system,    ///< mass matrix, rows and solver in a step without contacts
    contact_system, ///< the same in a step that touches only walls, and hits nothing
};
inline constexpr int k_stage_count = 14;

/// Set of stages. Plain bits: it crosses threads by copying.
struct Plan {
    std::uint32_t stages{(1U << static_cast<unsigned>(k_stage_count)) - 1U};

    [[nodiscard]] bool runs(Stage stage) const {
        return ((stages >> static_cast<unsigned>(stage)) & 1U) != 0U;
    }
    void leave_out(Stage stage) { stages &= ~(1U << static_cast<unsigned>(stage)); }
    friend bool operator==(const Plan&, const Plan&) = default;
};

/// One line of a plan for a person.
struct PlanLine {
    std::string_view stage;
    bool runs{true};
    /// Why it is left out; empty when it runs.
    std::string_view reason;
};

/// The stages that this tool needs among these neighbors. Owner thread; does not allocate.
[[nodiscard]] Plan choose_plan(const Model& model, const Neighborhood& neighborhood);

/// All stages in the order in which they run, with the reason for each one left out. Allocates.
[[nodiscard]] std::vector<PlanLine> describe(const Plan& plan);

/// Name of the solver that the step uses: "rigid, 3 freedoms", "linkage, 2 freedoms, fixed size", ….
[[nodiscard]] std::string_view kernel_name(const Model& model);

} // namespace haptics
