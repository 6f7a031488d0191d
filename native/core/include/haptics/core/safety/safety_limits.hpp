#pragma once
/// What the output gate holds the device to.

#include <haptics/core/figure_error.hpp>

#include <vector>

namespace haptics {

/// Limits of one output gate. The defaults suit a desktop pantograph held in the fingers.
struct SafetyLimits {
    /// Largest force, N, 0.01 to 100, and torque, N m, 1e-4 to 10; the whole wrench is scaled to fit both.
    double max_force{8.0};
    double max_torque{0.2};
    /// Fastest change that adds power, N/s, 1 to 1e7, and N m/s, 0.01 to 1e6. Changes that take power out are
    /// not limited.
    double force_slew{4000.0};
    double torque_slew{100.0};
    /// Moving mass (handle and what it carries), kg, 1e-3 to 100, and inertia, kg m^2, 1e-7 to 10, by which
    /// the gate judges whether a change takes energy out over a step (see output_gate.cpp). Give the larger
    /// of device and tool.
    double reference_mass{0.5};
    double reference_inertia{5.0e-4};
    /// Speed above which the output faults, m/s, 0.01 to 20, and rad/s, 0.1 to 500; power-adding output fades
    /// over the last fifth.
    double max_speed{2.0};
    double max_angular_speed{40.0};
    /// How long the speed must stay above its limit to fault, s, 0 to 0.1: a single bad velocity estimate is
    /// no fault.
    double speed_patience{0.005};
    /// Most net energy given to the hand within about energy_window, J, 0.01 to 100.
    double max_energy{3.0};
    /// Time constant by which given energy is forgotten, s, 0.01 to 100.
    double energy_window{1.0};
    /// Time in which forces grow to full strength after arming, s, 0.001 to 10.
    double ramp_time{0.5};
    /// Time in which forces fade on pause, and come back after it, s, 0.001 to 1.
    double pause_fade_time{0.05};
    /// Distance from the edge of reach within which forces fade, m, 1e-4 to 0.1.
    double workspace_fade{0.005};
    /// Distance beyond the edge at which the output faults, m, 1e-4 to 1.
    double workspace_overrun{0.02};
    /// Singularity measure below which forces fade, 0.001 to 1; none below half of it.
    double singularity_fade{0.15};
    /// Fastest handle that counts as at rest, m/s, 1e-5 to 1, and rad/s, 1e-4 to 10, and for how long, s, 0
    /// to 10, before arming.
    double rest_speed{0.02};
    double rest_angular_speed{0.5};
    double rest_time{0.05};
    /// Largest command that counts as free space when arming, N, 0 to 10, and N m, 0 to 1.
    double arming_force{0.5};
    double arming_torque{0.02};
};

/// Every figure out of range, with its remedy. Empty when usable. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const SafetyLimits& limits);

} // namespace haptics
