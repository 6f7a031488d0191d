@tool
@icon("res://addons/haptics/icons/haptic_simulated_pantograph.svg")
class_name HapticSimulatedPantograph
extends HapticDevice
## A planar pantograph without hardware: handle, friction, encoders, delay, motors, and the hand
## that holds it.

## Where the handle's inertia comes from.
enum InertiaModel {
	## [member mass] and [member inertia], the same everywhere.
	CONSTANT,
	## Links, rotors, handle and joint friction of the linkage; motors hold torques between samples.
	LINKAGE,
}

## How the handle's pose is measured.
enum EncoderModel {
	## Exactly.
	EXACT,
	## In steps of [member encoder_step] at the handle.
	HANDLE,
	## In counts of the encoders at the joints.
	JOINT,
}

const Choices := preload("choices.gd")

const _INERTIA_MODELS: PackedStringArray = ["constant", "linkage"]
const _ENCODER_MODELS: PackedStringArray = ["exact", "handle", "joint"]

## Its linkage, motors and encoders; without one the UBC twin pantograph (x, y and angle, assumed
## figures).
@export var geometry: HapticPantographGeometry:
	set(value):
		geometry = value
		emit_changed()

@export_group("Hand")
## The hand that holds it; without one nobody does.
@export var hand: HapticSimulatedHand:
	set(value):
		hand = value
		emit_changed()
## The hand when nobody is there: without a display and in lock-step runs. Without one it is
## [member hand], which nobody moves when it is the mouse.
@export var hand_unattended: HapticSimulatedHand:
	set(value):
		hand_unattended = value
		emit_changed()

@export_group("Handle")
## Where the handle's inertia comes from.
@export var inertia_model: InertiaModel = InertiaModel.CONSTANT:
	set(value):
		inertia_model = value
		emit_changed()
## Mass of a [constant CONSTANT] handle, kg, 0.001 to 100.
@export_range(0.001, 2.0, 0.001, "or_greater", "suffix:kg") var mass: float = 0.3:
	set(value):
		mass = value
		emit_changed()
## Inertia of a [constant CONSTANT] handle, kg m², 1e-7 to 10.
@export_range(0.0000001, 0.01, 0.0000001, "or_greater", "suffix:kg m²") var inertia: float = 0.0003:
	set(value):
		inertia = value
		emit_changed()
## Viscous friction, N s/m, 0 to 1000.
@export_range(0.0, 20.0, 0.01, "or_greater", "suffix:N s/m") var viscous_friction: float = 1.0:
	set(value):
		viscous_friction = value
		emit_changed()
## Viscous friction of turning, N m s/rad, 0 to 10.
@export_range(0.0, 0.1, 0.0001, "or_greater", "suffix:N m s/rad")
var rotation_viscous_friction: float = 0.001:
	set(value):
		rotation_viscous_friction = value
		emit_changed()
## Coulomb friction, N, 0 to 100.
@export_range(0.0, 5.0, 0.01, "or_greater", "suffix:N") var coulomb_friction: float = 0.0:
	set(value):
		coulomb_friction = value
		emit_changed()
## Coulomb friction of turning, N m, 0 to 10.
@export_range(0.0, 0.1, 0.0001, "or_greater", "suffix:N m")
var rotation_coulomb_friction: float = 0.0:
	set(value):
		rotation_coulomb_friction = value
		emit_changed()

## Gravity in the device's plane, m/s², in the axes of the screen (y down), each within 50; zero
## for a device that lies flat.
@export_custom(PROPERTY_HINT_NONE, "suffix:m/s²") var gravity: Vector2 = Vector2.ZERO:
	set(value):
		gravity = value
		emit_changed()

@export_group("Encoders and delay")
## How the pose is measured.
@export var encoder_model: EncoderModel = EncoderModel.JOINT:
	set(value):
		encoder_model = value
		emit_changed()
## Step of a [constant HANDLE] encoder, m, 0 to 0.1.
@export_range(0.0, 0.001, 0.0000001, "suffix:m") var encoder_step: float = 0.00001:
	set(value):
		encoder_step = value
		emit_changed()
## Step of the angle of a [constant HANDLE] encoder, rad, 0 to 0.1.
@export_range(0.0, 0.01, 0.000001, "suffix:rad") var encoder_angle_step: float = 0.0001:
	set(value):
		encoder_angle_step = value
		emit_changed()
## Haptic steps by which a force acts late, 0 to 1000.
@export_range(0, 20, 1, "or_greater", "suffix:steps") var command_delay_steps: int = 0:
	set(value):
		command_delay_steps = value
		emit_changed()
## Time by which a force acts late on top of that, s, 0 to 1.
@export_range(0.0, 0.02, 0.0001, "or_greater", "suffix:s") var command_delay: float = 0.0:
	set(value):
		command_delay = value
		emit_changed()
## Haptic steps by which a reading is late, 0 to 1000.
@export_range(0, 20, 1, "or_greater", "suffix:steps") var reading_delay_steps: int = 0:
	set(value):
		reading_delay_steps = value
		emit_changed()
## Readings carry the force of the hand on the handle, as a force sensor gives.
@export var measures_force: bool = false:
	set(value):
		measures_force = value
		emit_changed()
## Readings carry the velocity.
@export var measures_velocity: bool = false:
	set(value):
		measures_velocity = value
		emit_changed()

@export_group("Limits")
## The motors hold to their torque limits.
@export var limit_motors: bool = true:
	set(value):
		limit_motors = value
		emit_changed()
## The handle stops at the edge of the workspace.
@export var bounded: bool = true:
	set(value):
		bounded = value
		emit_changed()


func to_settings(unattended: bool) -> Dictionary:
	var settings := {
		"kind": "simulated_pantograph",
		"geometry": _linkage(),
		"gravity": PackedFloat64Array([gravity.x, -gravity.y]),
		"inertia_model": Choices.name_of(_INERTIA_MODELS, inertia_model),
		"mass": mass,
		"inertia": inertia,
		"viscous_friction": viscous_friction,
		"rotation_viscous_friction": rotation_viscous_friction,
		"coulomb_friction": coulomb_friction,
		"rotation_coulomb_friction": rotation_coulomb_friction,
		"encoder_model": Choices.name_of(_ENCODER_MODELS, encoder_model),
		"encoder_resolution": PackedFloat64Array([encoder_step, encoder_step, encoder_angle_step]),
		"command_delay": command_delay,
		"command_delay_steps": command_delay_steps,
		"reading_delay_steps": reading_delay_steps,
		"limit_motors": limit_motors,
		"bounded": bounded,
		"measures_force": measures_force,
		"measures_velocity": measures_velocity,
	}
	if compensation != null:
		settings["compensation"] = compensation.to_settings()
	var holder := hand_for(unattended)
	if holder != null:
		settings["hand"] = holder.to_settings()
	return settings


## The hand that holds it then; null for none.
func hand_for(unattended: bool) -> HapticSimulatedHand:
	return hand_unattended if unattended and hand_unattended != null else hand


func moving_mass(unattended: bool) -> float:
	var holder := hand_for(unattended)
	return _own("mass_kg", mass) + (holder.mass if holder != null else 0.0)


func moving_inertia(unattended: bool) -> float:
	var holder := hand_for(unattended)
	return _own("inertia_kg_m2", inertia) + (holder.inertia if holder != null else 0.0)


func follows_mouse(unattended: bool) -> bool:
	var holder := hand_for(unattended)
	return holder != null and holder.kind == HapticSimulatedHand.Kind.MOUSE


func get_problems(unattended: bool) -> PackedStringArray:
	var holder := hand_for(unattended)
	return holder.get_problems() if holder != null else PackedStringArray()


# figures of the linkage, or the name of the preset
func _linkage() -> Variant:
	if geometry == null:
		return "ubc_twin_pantograph"
	return geometry.to_settings()


# what the linkage says of itself, or the constant handle's figure
func _own(figure: String, constant: float) -> float:
	if inertia_model == InertiaModel.CONSTANT:
		return constant
	var linkage := geometry
	if linkage == null:
		linkage = HapticPantographGeometry.create(
			HapticPantographGeometry.Preset.UBC_TWIN_PANTOGRAPH
		)
	return linkage.get_figures().get(figure, constant)
