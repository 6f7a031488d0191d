#include <haptics/core/safety/safety_limits.hpp>

namespace haptics {

std::vector<FigureError> validate(const SafetyLimits& limits) {
    constexpr const char* k_device = "Take the limit from the device's data sheet, or keep the default.";
    constexpr const char* k_time = "Give times in seconds, or keep the default.";
    constexpr const char* k_hand = "Choose what a hand can bear, or keep the default.";
    FigureCheck check;
    check.range("max_force", limits.max_force, 0.01, 100.0, "N", k_device);
    check.range("max_torque", limits.max_torque, 1.0e-4, 10.0, "N m", k_device);
    check.range("force_slew", limits.force_slew, 1.0, 1.0e7, "N/s", k_hand);
    check.range("torque_slew", limits.torque_slew, 0.01, 1.0e6, "N m/s", k_hand);
    check.range("reference_mass", limits.reference_mass, 1.0e-3, 100.0, "kg",
                "Give the larger mass of device and tool.");
    check.range("reference_inertia", limits.reference_inertia, 1.0e-7, 10.0, "kg m^2",
                "Give the larger inertia of device and tool.");
    check.range("max_speed", limits.max_speed, 0.01, 20.0, "m/s", k_hand);
    check.range("max_angular_speed", limits.max_angular_speed, 0.1, 500.0, "rad/s", k_hand);
    check.range("speed_patience", limits.speed_patience, 0.0, 0.1, "s", k_time);
    check.range("max_energy", limits.max_energy, 0.01, 100.0, "J", k_hand);
    check.range("energy_window", limits.energy_window, 0.01, 100.0, "s", k_time);
    check.range("ramp_time", limits.ramp_time, 0.001, 10.0, "s", k_time);
    check.range("pause_fade_time", limits.pause_fade_time, 0.001, 1.0, "s", k_time);
    check.range("workspace_fade", limits.workspace_fade, 1.0e-4, 0.1, "m", k_device);
    check.range("workspace_overrun", limits.workspace_overrun, 1.0e-4, 1.0, "m", k_device);
    check.range("singularity_fade", limits.singularity_fade, 0.001, 1.0, "", k_device);
    check.range("rest_speed", limits.rest_speed, 1.0e-5, 1.0, "m/s", k_hand);
    check.range("rest_angular_speed", limits.rest_angular_speed, 1.0e-4, 10.0, "rad/s", k_hand);
    check.range("rest_time", limits.rest_time, 0.0, 10.0, "s", k_time);
    check.range("arming_force", limits.arming_force, 0.0, 10.0, "N", k_hand);
    check.range("arming_torque", limits.arming_torque, 0.0, 1.0, "N m", k_hand);
    return check.take();
}

} // namespace haptics
