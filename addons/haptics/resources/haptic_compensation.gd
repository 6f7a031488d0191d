@tool
@icon("res://addons/haptics/icons/haptic_compensation.svg")
class_name HapticCompensation
extends Resource
## What of a pantograph's own weight, friction and inertia the motors take off the hand.
##
## Never more than is passive when masses and friction are 30 % off their figures: nobody can get
## energy out of the device by moving it. Friction and inertia need the friction figures of the
## device's [HapticPantographGeometry]; friction also pays for the inertia compensation, so the more
## of it is compensated, the less inertia is. docs/devices.md has the derivation in words.

## Gravity in the device's plane, m/s², in the axes of the screen (y down), each within 50: zero
## for a device that lies flat, (0, 9.81) for one that stands upright. Links and handle are held.
@export_custom(PROPERTY_HINT_NONE, "suffix:m/s²") var gravity: Vector2 = Vector2.ZERO
## Share of the joints' friction, 0 to 0.7.
@export_range(0.0, 0.7, 0.01) var friction_share: float = 0.0
## Largest share of the inertia, 0 to 0.5.
@export_range(0.0, 0.5, 0.01) var inertia_share: float = 0.0

@export_group("Filters")
## Length of the velocity estimate, s, 0.001 to 0.05: longer is smoother and later.
@export_range(0.001, 0.05, 0.001, "suffix:s") var velocity_window: float = 0.008
## Joint rate from which on Coulomb friction is compensated in full, rad/s, 0.001 to 10.
@export_range(0.001, 1.0, 0.001, "or_greater", "suffix:rad/s") var coulomb_rate: float = 0.1
## Corner frequency of the acceleration, Hz, 1 to 100: higher follows faster motion and grains.
@export_range(1.0, 100.0, 0.1, "suffix:Hz") var acceleration_bandwidth: float = 20.0
## Most energy that inertia compensation may save up and lend again, J, 0 to 0.1.
@export_range(0.0, 0.1, 0.0001, "suffix:J") var energy_reserve: float = 0.005


## As the native side takes it.
func to_settings() -> Dictionary:
	return {
		"gravity": PackedFloat64Array([gravity.x, -gravity.y]),
		"friction_share": friction_share,
		"inertia_share": inertia_share,
		"velocity_window": velocity_window,
		"coulomb_rate": coulomb_rate,
		"acceleration_bandwidth": acceleration_bandwidth,
		"energy_reserve": energy_reserve,
	}
