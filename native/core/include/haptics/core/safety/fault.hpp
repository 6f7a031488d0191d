#pragma once
/// Why the output is off. A bit field whose members name the remedy.

#include <cstdint>

namespace haptics {

/// Latched causes; several may be set. Each member says what to do before re-arming.
enum class Fault : std::uint32_t {
    none = 0,
    /// The controller commanded NaN or infinity.
    fix_the_controller = 1U << 0U,
    /// Handle pose or velocity was NaN or infinite.
    check_the_encoders = 1U << 1U,
    /// The handle moved faster than the speed limit.
    move_slower_or_soften_the_coupling = 1U << 2U,
    /// More energy went into the hand than the limit allows.
    soften_the_coupling_or_add_damping = 1U << 3U,
    /// The handle left the workspace by more than the fade distance.
    bring_the_handle_back_into_the_workspace = 1U << 4U,
    /// The encoders contradict one another (one slipped).
    home_the_device_again = 1U << 5U,
    /// The step time was zero, negative or not a number.
    restart_the_loop = 1U << 6U,
    /// No sample came from the device in time.
    reconnect_the_device = 1U << 7U,
    /// Somebody pressed stop.
    release_the_stop = 1U << 8U,
    /// The passivity check found the controller to create energy.
    lower_the_stiffness = 1U << 9U,
    /// An encoder jumped farther between two samples than a joint can turn, or reported an error of its own.
    check_the_encoder_wiring = 1U << 10U,
    /// The device let its motors go because no command reached it in time.
    give_the_loop_more_time = 1U << 11U,
    /// The device reports a fault of its own: a motor driver gave up, or it is too warm.
    let_the_device_recover = 1U << 12U,
    /// The model of the scene ran away (StepOutput::diverged).
    make_the_scene_milder = 1U << 13U,
};

/// Union of causes.
constexpr Fault operator|(Fault a, Fault b) {
    return static_cast<Fault>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
/// Common causes.
constexpr Fault operator&(Fault a, Fault b) {
    return static_cast<Fault>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
/// True when `set` holds any bit of `bits`.
constexpr bool has(Fault set, Fault bits) {
    return (set & bits) != Fault::none;
}

/// Number of fault bits.
inline constexpr int k_fault_count = 14;
/// Cause and remedy of one bit (0 to k_fault_count - 1) as a sentence; static storage. Empty for any other
/// bit.
const char* describe_fault(int bit);

} // namespace haptics
