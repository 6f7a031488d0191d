#pragma once
/// The geometry near the tool as the virtual environment last saw it: an immutable, pointer-free snapshot
/// that the scene writes at its physics tick and the haptic loop reads.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/dynamics/linkage_spec.hpp>
#include <haptics/core/local_model/movable.hpp>
#include <haptics/core/local_model/plan.hpp>

#include <array>
#include <cstdint>

namespace haptics {

struct Neighborhood {
    /// Number of the snapshot, growing by one; 0 means none yet.
    std::uint64_t sequence{0};
    /// Loop-clock time at which the poses held, s.
    double time{0.0};
    /// Length of the environment's tick, s, > 0.
    double tick{1.0 / 60.0};
    /// The haptic step whose report the movable bodies of this snapshot reflect: the impulses of that report
    /// were given to them before the environment's last tick.
    std::uint64_t echo_step{0};
    /// Beliefs of that report, unchanged.
    std::int32_t echo_count{0};
    std::array<MovableBelief, k_max_movables> echo;
    /// Acceleration of free fall in scene axes, m/s^2.
    Vec2 gravity{0.0, 0.0};
    /// Layers that each link of the tool does not touch; of a rigid tool the first counts.
    std::array<std::uint32_t, k_max_links> tool_ignores{};
    /// Stages that the step needs with these bodies (choose_plan); leaves out nothing unless chosen.
    Plan plan;
    /// Bodies that did not fit (a reported fault).
    std::int32_t overflow{0};
    BodySet bodies;
};

} // namespace haptics
