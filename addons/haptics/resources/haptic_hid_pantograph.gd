@tool
@icon("res://addons/haptics/icons/haptic_hid_pantograph.svg")
class_name HapticHidPantograph
extends HapticDevice
## A planar pantograph on USB that speaks the open HID protocol of docs/hid-protocol.md.
##
## It is opened when the world starts, in real time only; docs/devices.md says what the machine
## needs (hidapi, and a udev rule). Offsets, gears, torque limits and home pose come from the device
## itself. One with relative encoders needs [method HapticWorld2D.home_device] before any force.

# what the safety limits count with: handle, links and a light grip
const _MOVING_MASS := 0.5
const _MOVING_INERTIA := 0.0005

## Its linkage: lengths, masses, modes and friction; without one the UBC twin pantograph. The device
## has to have as many motors.
@export var geometry: HapticPantographGeometry:
	set(value):
		geometry = value
		emit_changed()
## USB vendor id, as lsusb shows it (there in hexadecimal; 0x1209 may be typed here), 1 to 65535.
@export_range(1, 65535) var vendor_id: int = 0x1209:
	set(value):
		vendor_id = value
		emit_changed()
## USB product id, 1 to 65535.
@export_range(1, 65535) var product_id: int = 0x0001:
	set(value):
		product_id = value
		emit_changed()
## Serial number of the device; empty takes the first one found.
@export var serial: String = "":
	set(value):
		serial = value
		emit_changed()

@export_group("Watch")
## Most that four encoders may disagree by before the output faults, rad, 0.0001 to 1.
@export_range(0.0001, 0.1, 0.0001, "or_greater", "suffix:rad") var encoder_tolerance: float = 0.005:
	set(value):
		encoder_tolerance = value
		emit_changed()
## Fastest that a joint can turn, rad/s, 1 to 10000; what moves faster is an encoder that jumped.
@export_range(1.0, 1000.0, 1.0, "or_greater", "suffix:rad/s") var max_joint_speed: float = 100.0:
	set(value):
		max_joint_speed = value
		emit_changed()


func to_settings(_unattended: bool) -> Dictionary:
	var settings := {
		"kind": "hid_pantograph",
		"geometry": _linkage(),
		"vendor_id": vendor_id,
		"product_id": product_id,
		"serial": serial,
		"encoder_tolerance": encoder_tolerance,
		"max_joint_speed": max_joint_speed,
	}
	if compensation != null:
		settings["compensation"] = compensation.to_settings()
	return settings


func moving_mass(_unattended: bool) -> float:
	return _MOVING_MASS


func moving_inertia(_unattended: bool) -> float:
	return _MOVING_INERTIA


# figures of the linkage, or the name of the preset
func _linkage() -> Variant:
	if geometry == null:
		return "ubc_twin_pantograph"
	return geometry.to_settings()
