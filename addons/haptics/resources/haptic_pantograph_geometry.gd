@tool
@icon("res://addons/haptics/icons/haptic_pantograph_geometry.svg")
class_name HapticPantographGeometry
extends Resource
## All figures of a planar pantograph: its one or two five-bars, motors, gears, encoders and handle.
##
## Choose a [member preset] and change what is different on your device. Everything is in the axes
## of the device's drawing, as its data sheet has it: x to the right, y up, angles
## counter-clockwise. Motors are counted left, right of the first five-bar, left, right of the
## second. What cannot be built is a configuration warning of the world that uses it. The defaults
## are the Pantograph Mk-II; docs/devices.md says where all figures come from.

## Pantographs that exist.
enum Preset {
	## Figures of your own.
	CUSTOM,
	## Two five-bars on one handle: x, y and angle. Only its layout is published: all figures are
	## assumed.
	UBC_TWIN_PANTOGRAPH,
	## Pantograph Mk-II: x and y, links 63/75 mm.
	PANTOGRAPH_MK2,
	## Haply 2DIY, second version: x and y, links 70/90 mm, coaxial motors.
	HAPLY_2DIY_V2,
	## Haply 2DIY, third version: x and y, links 70/90 mm, motors 38 mm apart.
	HAPLY_2DIY_V3,
}

## How many five-bars hold the handle.
enum Kind {
	## One: x and y, two motors.
	SINGLE,
	## Two: x, y and angle, four motors.
	TWIN,
}

## Which way an encoder counts up.
enum Direction {
	## Counter-clockwise.
	COUNTER_CLOCKWISE,
	## Clockwise.
	CLOCKWISE,
}

const Gateway := preload("../nodes/gateway.gd")
const Choices := preload("choices.gd")

const _PRESETS: Dictionary[Preset, String] = {
	Preset.UBC_TWIN_PANTOGRAPH: "ubc_twin_pantograph",
	Preset.PANTOGRAPH_MK2: "pantograph_mk2",
	Preset.HAPLY_2DIY_V2: "haply_2diy_v2",
	Preset.HAPLY_2DIY_V3: "haply_2diy_v3",
}
const _KINDS: PackedStringArray = ["single", "twin"]
const _SIGNS: PackedFloat64Array = [1.0, -1.0]

## Fills all figures below with those of a pantograph that exists. Shows [constant CUSTOM] when they
## are none's.
@export_custom(
	PROPERTY_HINT_ENUM,
	"Custom,UBC twin pantograph (assumed),Pantograph Mk-II,Haply 2DIY v2,Haply 2DIY v3",
	PROPERTY_USAGE_EDITOR
)
var preset: Preset:
	get = _get_preset,
	set = _set_preset

## How many five-bars hold the handle.
@export var kind: Kind = Kind.SINGLE:
	set(value):
		kind = value
		_resize_axes()
		notify_property_list_changed()

@export_group("Five-bars")
## The one five-bar, or the first of a twin.
@export var first: HapticFiveBar = HapticFiveBar.new()
## The second five-bar of a twin.
@export var second: HapticFiveBar
## Where the first five-bar of a twin holds the handle, in the handle's axes, m, each within 0.5.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var first_attachment: Vector2 = Vector2.ZERO
## Where the second five-bar holds the handle, m, each within 0.5.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var second_attachment: Vector2 = Vector2.ZERO

@export_group("Motors")
## Largest torque at a motor's shaft, N m, 0.0001 to 50.
@export_range(0.0001, 2.0, 0.0001, "or_greater", "suffix:N m") var torque_limit: float = 0.15
## Torque per current, N m/A, 0.0001 to 10.
@export_range(0.0001, 0.5, 0.0001, "or_greater", "suffix:N m/A") var torque_constant: float = 0.05
## Inertia of a rotor about its shaft, kg m², 0 to 0.1.
@export_range(0.0, 0.001, 0.0000001, "or_greater", "suffix:kg m²") var rotor_inertia: float = 3e-06
## Turns of the motor per turn of the joint, one for each motor, 0.1 to 500; 1 without a gear.
@export_range(0.1, 50.0, 0.001, "or_greater") var gear_ratios: PackedFloat64Array = [1.0, 1.0]
## Viscous friction at a joint, N m s/rad, 0 to 10; 0 when it is unknown, and not compensated then.
@export_range(0.0, 0.05, 0.0001, "or_greater", "suffix:N m s/rad") var viscous_friction: float = 0.0
## Coulomb friction at a joint, N m, 0 to 10; 0 when it is unknown, and not compensated then.
@export_range(0.0, 0.2, 0.0001, "or_greater", "suffix:N m") var coulomb_friction: float = 0.0

@export_group("Encoders")
## Counts per turn of the joint, all four edges and the gear included, 16 to 1e9.
@export_range(16.0, 300000.0, 1.0, "or_greater", "suffix:counts")
var counts_per_revolution: float = 65536.0
## Angle of each driven link at count 0, counter-clockwise from x, -720° to 720°.
@export_range(-360.0, 360.0, 0.01, "or_less", "or_greater", "radians_as_degrees")
var encoder_offsets: PackedFloat64Array = [0.0, 0.0]
## Which way each encoder counts up.
@export var encoder_directions: Array[Direction] = [
	Direction.COUNTER_CLOCKWISE, Direction.COUNTER_CLOCKWISE
]
## Watches for an encoder that slips (twin only: one five-bar cannot tell), and takes the force off
## until the device is homed.
@export var check_encoders: bool = true
## Largest error of one reading, counts, 0.5 (rounding alone) to 20. Larger tolerances hide more of
## a slip, smaller ones cry wolf.
@export_range(0.5, 5.0, 0.01, "or_greater", "suffix:counts") var reading_error: float = 0.75
## How well homing finds the encoders' zeros, rad, 0 to 0.1.
@export_range(0.0, 0.01, 0.0001, "or_greater", "suffix:rad") var offset_tolerance: float = 0.001
## How well links, axes and attachments are made, m, 0 to 0.01.
@export_range(0.0, 0.001, 0.000001, "or_greater", "suffix:m") var length_tolerance: float = 0.0001

@export_group("Handle")
## Mass of the handle, kg, 0.001 to 10.
@export_range(0.001, 0.5, 0.001, "or_greater", "suffix:kg") var handle_mass: float = 0.03
## Inertia of the handle about its origin, kg m², 1e-8 to 1.
@export_range(0.00000001, 0.001, 0.00000001, "or_greater", "suffix:kg m²")
var handle_inertia: float = 1e-05
## How far a twin's handle turns either way, 0.6° to 180°.
@export_range(1.0, 180.0, 0.1, "radians_as_degrees") var rotation_limit: float = PI / 3.0
## Handle in the middle of the workspace, m: where a simulated one starts, and the scene's origin.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var home: Vector2 = Vector2.ZERO
## Its angle there.
@export_range(-180.0, 180.0, 0.1, "radians_as_degrees") var home_angle: float = 0.0


## A geometry with the figures of a preset.
static func create(from: Preset) -> HapticPantographGeometry:
	var geometry := HapticPantographGeometry.new()
	geometry.preset = from
	return geometry


## 2 with one five-bar, 4 with two.
func get_motor_count() -> int:
	return 4 if kind == Kind.TWIN else 2


## As the native side takes it.
func to_settings() -> Dictionary:
	var settings := {
		"name": _label(),
		"kind": Choices.name_of(_KINDS, kind),
		"first_attachment": PackedFloat64Array([first_attachment.x, first_attachment.y]),
		"torque_limit": torque_limit,
		"torque_constant": torque_constant,
		"rotor_inertia": rotor_inertia,
		"gear_ratios": gear_ratios,
		"viscous_friction": viscous_friction,
		"coulomb_friction": coulomb_friction,
		"counts_per_revolution": counts_per_revolution,
		"encoder_offsets": encoder_offsets,
		"encoder_directions": _signs(),
		"check_encoders": check_encoders,
		"reading_error": reading_error,
		"offset_tolerance": offset_tolerance,
		"length_tolerance": length_tolerance,
		"handle_mass": handle_mass,
		"handle_inertia": handle_inertia,
		"rotation_limit": rotation_limit,
		"home": PackedFloat64Array([home.x, home.y]),
		"home_angle": home_angle,
	}
	if first != null:
		settings["first"] = first.to_settings()
	if kind == Kind.TWIN:
		var place := PackedFloat64Array([second_attachment.x, second_attachment.y])
		settings["second_attachment"] = place
		if second != null:
			settings["second"] = second.to_settings()
	return settings


## What cannot be built, one message for each figure, with the fix. Empty without the native
## library.
func get_problems() -> PackedStringArray:
	return get_figures().get("problems", PackedStringArray())


## What follows from the figures at the home pose: mass_kg (in the heaviest direction),
## inertia_kg_m2, reach_margin_m, singularity (0 to 1), least_force_n (in the weakest direction),
## resolution_m and resolution_rad of one count, and for a twin smallest_slip_counts. Only
## problems where there are any; empty without the native library.
func get_figures() -> Dictionary:
	return Gateway.describe_pantograph(to_settings())


func _label() -> String:
	var label := "HapticPantographGeometry"
	if resource_name != "":
		return '%s "%s"' % [label, resource_name]
	return label if resource_path == "" else "%s %s" % [label, resource_path]


func _signs() -> PackedFloat64Array:
	var signs := PackedFloat64Array()
	for direction: Direction in encoder_directions:
		# what is no direction is refused by the native side
		signs.append(_SIGNS[direction] if direction in Direction.values() else 0.0)
	return signs


func _resize_axes() -> void:
	while gear_ratios.size() < get_motor_count():
		gear_ratios.append(1.0)
	gear_ratios.resize(get_motor_count())
	encoder_offsets.resize(get_motor_count())
	encoder_directions.resize(get_motor_count())


func _get_preset() -> Preset:
	var own := to_settings()
	for candidate: Preset in _PRESETS:
		var figures := Gateway.pantograph_preset(_PRESETS[candidate])
		if not figures.is_empty() and _is_same(figures, own):
			return candidate
	return Preset.CUSTOM


func _set_preset(value: Preset) -> void:
	if not _PRESETS.has(value):
		return
	var figures := Gateway.pantograph_preset(_PRESETS[value])
	if figures.is_empty():
		return
	kind = _KINDS.find(figures["kind"] as String) as Kind
	second = null
	for key: String in figures:
		match key:
			"kind":
				pass
			"first", "second":
				set(key, HapticFiveBar.from_settings(figures[key] as Dictionary))
			"first_attachment", "second_attachment", "home":
				var place: PackedFloat64Array = figures[key]
				set(key, Vector2(place[0], place[1]))
			"encoder_directions":
				for i: int in get_motor_count():
					var counts_up: float = (figures[key] as PackedFloat64Array)[i]
					encoder_directions[i] = _SIGNS.find(counts_up) as Direction
			_:
				set(key, figures[key])
	notify_property_list_changed()
	emit_changed()


# true when `own` has all of these figures, to what a Vector2 can hold
static func _is_same(figures: Dictionary, own: Dictionary) -> bool:
	for key: String in figures:
		var wanted: Variant = figures[key]
		var found: Variant = own.get(key)
		if wanted is Dictionary:
			if not found is Dictionary or not _is_same(wanted as Dictionary, found as Dictionary):
				return false
		elif wanted is PackedFloat64Array:
			if not _is_near(wanted as PackedFloat64Array, found as PackedFloat64Array):
				return false
		elif wanted is float:
			if not is_equal_approx(wanted as float, found as float):
				return false
		elif wanted != found:
			return false
	return true


static func _is_near(wanted: PackedFloat64Array, found: PackedFloat64Array) -> bool:
	if wanted.size() != found.size():
		return false
	for i: int in wanted.size():
		if absf(wanted[i] - found[i]) > 1e-6:
			return false
	return true


func _validate_property(property: Dictionary) -> void:
	var of_twins: Array[StringName] = [
		&"second", &"first_attachment", &"second_attachment", &"rotation_limit", &"home_angle"
	]
	if kind == Kind.SINGLE and property["name"] in of_twins:
		property["usage"] = PROPERTY_USAGE_NO_EDITOR
