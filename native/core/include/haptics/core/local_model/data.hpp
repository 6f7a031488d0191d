#pragma once
/// State of the local model and the memory it works on. Large: set it aside once, before the loop starts.

#include <haptics/core/contact/body_cache.hpp>
#include <haptics/core/contact/contact.hpp>
#include <haptics/core/dynamics/articulated.hpp>
#include <haptics/core/local_model/contact_system.hpp>
#include <haptics/core/local_model/model.hpp>
#include <haptics/core/local_model/movable.hpp>
#include <haptics/core/local_model/neighborhood.hpp>
#include <haptics/core/local_model/plan.hpp>
#include <haptics/core/local_model/track.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// Neighbors that the next snapshot no longer lists but that the tool still touches; scratch memory of
/// take_neighborhood.
struct Leavers {
    static constexpr int k_bodies = 8;
    static constexpr int k_pieces = 64;
    std::int32_t body_count{0};
    std::int32_t piece_count{0};
    std::array<Body, k_bodies> body;
    std::array<Track, k_bodies> track;
    std::array<Piece, k_pieces> piece;
};

/// What a joint of the tool remembers from step to step.
struct JointMemory {
    /// Displacement of the friction spring from its anchor, rad or m.
    double slip_spring{0.0};
    bool sliding{false};
    /// The joint rested against a limit.
    bool at_limit{false};
};

struct Data {
    /// Steps done.
    std::uint64_t step{0};
    /// Loop-clock time of the state, s.
    double time{0.0};
    /// Length of the last step, s.
    double step_length{0.001};
    /// Mass of a rigid tool, or of all links, kg.
    double tool_mass{0.1};
    /// Proxy: pose and velocity of the center of mass of a rigid tool, or of the held link.
    Pose pose{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
    /// Proxy in configuration space, and what follows from it, when the tool is a linkage.
    LinkageData linkage;
    ArticulatedFactor factor;
    /// Half of what the last step's forces changed the velocity by.
    LinkageVector half_step;
    /// Most that the kinetic energy of a linkage may be, J (see proxy.cpp).
    double energy_budget{0.0};
    Slots<JointMemory, k_max_freedoms> joint;
    /// Wrenches on the links of the tool from outside of the model (scene axes, about each center of mass, N,
    /// N, N m), while `pushed`; see free_linkage.hpp.
    bool pushed{false};
    std::array<Wrench, k_max_links> push;
    /// Where the tool is held.
    Grip grip;
    /// The tool's shapes at the present poses and the neighbors at their extrapolated poses.
    BodySet tool;
    BodySet neighbors;
    /// What detection keeps of the two while their shapes stay.
    BodyCache tool_cache;
    BodyCache neighbor_cache;
    /// The snapshot that the neighbors come from.
    std::uint64_t sequence{0};
    double snapshot_time{0.0};
    double tick{1.0 / 60.0};
    /// How late snapshots come, as far as the last ones tell, s.
    double latency{0.0};
    Vec2 gravity{0.0, 0.0};
    /// Work on the tool of what neighbors were corrected by since the last step, J.
    double correction_work{0.0};
    /// Stages that run.
    Plan plan;
    /// One per neighbor. Neighbors that fade out come after those of the snapshot.
    std::array<Track, k_max_bodies> track;
    std::array<Track, k_max_bodies> next_track;
    Leavers leavers;
    std::int32_t movable_count{0};
    /// Movables of the snapshot that found no place and act as kinematic (a reported fault).
    std::int32_t movable_overflow{0};
    std::array<MovableState, k_max_movables> movable;
    /// Of two movables that are links of one linkage: velocity of the first for a unit impulse on the other.
    std::array<std::array<Mat3, k_max_movables>, k_max_movables> link_coupling;
    PatchList patches;
    PatchList previous;
    /// Patches at the start of a part of the step (exact integrator).
    PatchList stretch;
    ContactSystem system;
    CollisionProblem collision;
    CollisionSolution solution;
    CollisionWorkspace workspace;
    /// Bodies that the tool touches, by id.
    std::int32_t touched_count{0};
    std::array<std::uint64_t, k_max_patches> touched;
};

} // namespace haptics
