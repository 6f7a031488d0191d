@tool
@icon("res://addons/haptics/icons/haptic_device.svg")
class_name HapticDevice
extends Resource
## What the user holds. Use one of its kinds, as [HapticSimulatedPantograph].

## What of its own weight, friction and inertia is taken off the hand; without one nothing.
@export var compensation: HapticCompensation:
	set(value):
		compensation = value
		emit_changed()


## As the native side takes it. `unattended`: nobody is there to move it.
func to_settings(_unattended: bool) -> Dictionary:
	return {}


## Moving mass at the handle, the hand's included, kg.
func moving_mass(_unattended: bool) -> float:
	return 0.0


## Moving inertia at the handle, the hand's included, kg m².
func moving_inertia(_unattended: bool) -> float:
	return 0.0


## True when the mouse plays the hand.
func follows_mouse(_unattended: bool) -> bool:
	return false


## What is wrong with it, beside figures out of range.
func get_problems(_unattended: bool) -> PackedStringArray:
	return []
