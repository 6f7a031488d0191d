@tool
@icon("res://addons/haptics/icons/haptic_safety_limits.svg")
class_name HapticSafetyLimits
extends Resource
## What every force on its way to the device is held to. The defaults suit a desktop pantograph
## held in the fingers.

## Largest force, N, 0.01 to 100; the whole wrench is scaled to fit.
@export_range(0.01, 30.0, 0.01, "or_greater", "suffix:N") var max_force: float = 8.0
## Largest torque, N m, 0.0001 to 10; the whole wrench is scaled to fit.
@export_range(0.0001, 1.0, 0.0001, "or_greater", "suffix:N m") var max_torque: float = 0.2
## Fastest change of force that adds power, N/s, 1 to 10000000. What takes power out is not limited.
@export_range(1.0, 20000.0, 1.0, "or_greater", "suffix:N/s") var force_slew: float = 4000.0
## Fastest change of torque that adds power, N m/s, 0.01 to 1000000.
@export_range(0.01, 1000.0, 0.01, "or_greater", "suffix:N m/s") var torque_slew: float = 100.0
## Speed of the handle above which the output faults, m/s, 0.01 to 20.
@export_range(0.01, 5.0, 0.01, "or_greater", "suffix:m/s") var max_speed: float = 2.0
## The same for turning, rad/s, 0.1 to 500.
@export_range(0.1, 100.0, 0.1, "or_greater", "suffix:rad/s") var max_angular_speed: float = 40.0
## Most net energy given to the hand within about a second, J, 0.01 to 100.
@export_range(0.01, 20.0, 0.01, "or_greater", "suffix:J") var max_energy: float = 3.0
## Time in which forces grow to full strength after arming, s, 0.001 to 10.
@export_range(0.001, 3.0, 0.001, "or_greater", "suffix:s") var ramp_time: float = 0.5
## Time in which forces fade on pause, and come back after it, s, 0.001 to 1.
@export_range(0.001, 1.0, 0.001, "suffix:s") var pause_fade_time: float = 0.05


## As the native side takes it. The masses that move with handle and tool tell the gate which
## changes of force take energy out.
func to_settings(reference_mass: float, reference_inertia: float) -> Dictionary:
	var ceiling := HapticSettings.number(HapticSettings.FORCE_CEILING)
	return {
		# what is not a number stays it, for the check to see
		"max_force": ceiling if max_force > ceiling else max_force,
		"max_torque": max_torque,
		"force_slew": force_slew,
		"torque_slew": torque_slew,
		"reference_mass": reference_mass,
		"reference_inertia": reference_inertia,
		"max_speed": max_speed,
		"max_angular_speed": max_angular_speed,
		"max_energy": max_energy,
		"ramp_time": ramp_time,
		"pause_fade_time": pause_fade_time,
	}
