#pragma once
/// What a haptic step leaves behind for the scene: the latest values, counters that only grow, no pointers.

#include <haptics/core/contact/contact.hpp>
#include <haptics/core/dynamics/linkage_spec.hpp>
#include <haptics/core/local_model/movable.hpp>
#include <haptics/core/safety/output_gate.hpp>
#include <haptics/core/types.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// One touching patch, for drawing and for games.
struct ContactReport {
    /// Body::id of the neighbor.
    std::uint64_t body{0};
    /// Link of the tool that touches it, 0 for a rigid tool.
    std::int32_t link{0};
    ContactState state{ContactState::none};
    /// Middle of the patch and normal out of the neighbor, scene axes.
    Vec2 position{0.0, 0.0};
    Vec2 normal{0.0, 1.0};
    /// N.
    double normal_force{0.0};
    double tangent_force{0.0};
    /// Deepest overlap, m.
    double penetration{0.0};
};

/// Figures of the whole run so far.
struct RunFigures {
    /// Largest force that left the gate, N.
    double max_force{0.0};
    /// Deepest overlap, m.
    double max_penetration{0.0};
    /// Sum of squared distances between handle and grip while held and armed (m^2), and how many.
    double error_sum{0.0};
    std::uint64_t error_count{0};
    /// Collisions resolved, patches counted.
    std::uint64_t collisions{0};
};

struct HapticReport {
    static constexpr int k_max_contacts = 16;

    /// Steps done, and loop-clock time after the step, s.
    std::uint64_t step{0};
    double time{0.0};
    /// Where the handle wants the grip (scene frame), and its velocity.
    Pose device{0.0, 0.0, 0.0};
    Twist device_velocity{0.0, 0.0, 0.0};
    /// Center of mass and grip of the proxy.
    Pose proxy{0.0, 0.0, 0.0};
    Pose grip{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
    /// Part of the force that the hand has of the tool: 0 while a clutch leaves the handle free.
    double hand_share{1.0};
    /// Coordinates of a linkage and their rates (rad or m; a floating base first has the pose of its center
    /// of mass), and the link that is held; no freedoms for a rigid tool.
    std::int32_t freedoms{0};
    std::int32_t held_link{0};
    std::array<double, k_max_freedoms> configuration{};
    std::array<double, k_max_freedoms> configuration_rate{};
    /// Force that left the output gate for the hand (scene axes), N, N, N m.
    Wrench force{0.0, 0.0, 0.0};
    /// The part of it that holds the device's own weight, friction and inertia.
    Wrench compensation{0.0, 0.0, 0.0};
    /// What was asked of the gate.
    Wrench command{0.0, 0.0, 0.0};
    /// Contact force on the tool, coupling on the proxy, measured hand force, all about the grip.
    Wrench contact{0.0, 0.0, 0.0};
    Wrench coupling{0.0, 0.0, 0.0};
    Wrench hand{0.0, 0.0, 0.0};
    /// Impulse force in `command`, and the channel's books: demanded = delivered + pending + dropped, N s.
    Wrench impulse_force{0.0, 0.0, 0.0};
    Wrench impulse_demanded{0.0, 0.0, 0.0};
    Wrench impulse_delivered{0.0, 0.0, 0.0};
    Wrench impulse_dropped{0.0, 0.0, 0.0};
    int contacts{0};
    int colliding{0};
    int sticking{0};
    int sliding{0};
    double max_penetration{0.0};
    /// Net energy that the controller gave to the hand out of nothing since the start, J, >= 0.
    double energy_injected{0.0};
    bool held{false};
    bool armed{false};
    /// Asked for force; while it is off without a fault, `arming` says what it waits for.
    bool arm_wanted{false};
    ArmResult arming{ArmResult::hold_the_handle_still};
    GateFlag gate{GateFlag::none};
    Fault faults{Fault::none};
    /// Steps in which a solver used its fallback, those of them in which the exact integrator gave way to the
    /// linearly implicit one, contact patches dropped, movables without a place: grow only.
    std::uint64_t fallbacks{0};
    std::uint64_t exact_gave_way{0};
    std::uint64_t patch_overflow{0};
    std::int32_t movable_overflow{0};
    /// The device gave no new sample in this step.
    bool reading_missing{false};
    std::int32_t contact_count{0};
    std::array<ContactReport, k_max_contacts> contact_list;
    std::int32_t movable_count{0};
    std::array<MovableBelief, k_max_movables> movable;
    RunFigures run;
    /// Device's buttons.
    std::uint32_t buttons{0};
};

} // namespace haptics
