@tool
@icon("res://addons/haptics/icons/haptic_simulated_hand.svg")
class_name HapticSimulatedHand
extends Resource
## The hand that holds a simulated device: it pushes, follows a recorded path, or follows the mouse
## with a spring, a damper and a limited force, as fingers do.

## What the hand does.
enum Kind {
	## Lets go.
	NONE,
	## Pushes with [member force] and [member torque].
	CONSTANT_FORCE,
	## Follows [member path].
	RECORDED_PATH,
	## Follows the mouse.
	MOUSE,
}

const _NAMES: Dictionary[Kind, String] = {
	Kind.NONE: "none",
	Kind.CONSTANT_FORCE: "constant_force",
	Kind.RECORDED_PATH: "recorded_path",
	Kind.MOUSE: "target",
}

## What the hand does.
@export var kind: Kind = Kind.MOUSE:
	set(value):
		kind = value
		notify_property_list_changed()
		emit_changed()

## Mass that moves with the handle, kg, 0 to 10.
@export_range(0.0, 2.0, 0.001, "or_greater", "suffix:kg") var mass: float = 0.15:
	set(value):
		mass = value
		emit_changed()

## Inertia that turns with the handle, kg m², 0 to 0.1.
@export_range(0.0, 0.01, 0.000001, "or_greater", "suffix:kg m²") var inertia: float = 0.00015:
	set(value):
		inertia = value
		emit_changed()

@export_group("Grip")
## How stiffly the hand goes where it wants to be, N/m, 0 to 100000.
@export_range(0.0, 2000.0, 1.0, "or_greater", "suffix:N/m") var stiffness: float = 300.0:
	set(value):
		stiffness = value
		emit_changed()
## The same for turning, N m/rad, 0 to 1000.
@export_range(0.0, 5.0, 0.01, "or_greater", "suffix:N m/rad") var rotation_stiffness: float = 0.5:
	set(value):
		rotation_stiffness = value
		emit_changed()
## Damping over critical damping of hand and handle together, 0 to 10; 1 is critical.
@export_range(0.0, 3.0, 0.01, "or_greater") var damping_ratio: float = 1.0:
	set(value):
		damping_ratio = value
		emit_changed()
## The most the hand can push, N, 0 to 1000.
@export_range(0.0, 30.0, 0.1, "or_greater", "suffix:N") var max_force: float = 8.0:
	set(value):
		max_force = value
		emit_changed()
## The most the hand can turn, N m, 0 to 100.
@export_range(0.0, 1.0, 0.01, "or_greater", "suffix:N m") var max_torque: float = 0.2:
	set(value):
		max_torque = value
		emit_changed()

@export_group("Constant force")
## Push of a [constant CONSTANT_FORCE] hand, in the axes of the screen (y down).
@export_custom(PROPERTY_HINT_NONE, "suffix:N") var force: Vector2 = Vector2.ZERO:
	set(value):
		force = value
		emit_changed()
## Turning push of a [constant CONSTANT_FORCE] hand, clockwise on the screen.
@export_range(-1.0, 1.0, 0.001, "or_less", "or_greater", "suffix:N m") var torque: float = 0.0:
	set(value):
		torque = value
		emit_changed()
## When the push begins, after the start.
@export_range(0.0, 10.0, 0.001, "or_greater", "suffix:s") var start_time: float = 0.0:
	set(value):
		start_time = value
		emit_changed()

@export_group("Recorded path")
## Times of [member path], growing strictly.
@export_custom(PROPERTY_HINT_NONE, "suffix:s") var path_times: PackedFloat64Array = []:
	set(value):
		path_times = value
		emit_changed()
## Where a [constant RECORDED_PATH] hand wants to be at [member path_times]: x and y (m, y down)
## and angle (rad, clockwise), from where it starts. Begin with zeros.
@export var path: PackedVector3Array = []:
	set(value):
		path = value
		emit_changed()
## Rounds the path's corners off; else it runs straight from point to point.
@export var smooth: bool = true:
	set(value):
		smooth = value
		emit_changed()
## Begins again at the end.
@export var repeat: bool = false:
	set(value):
		repeat = value
		emit_changed()


## As the native side takes it.
func to_settings() -> Dictionary:
	var settings := {"kind": _NAMES.get(kind, str(kind)), "mass": mass, "inertia": inertia}
	if kind == Kind.CONSTANT_FORCE:
		settings["force"] = PackedFloat64Array([force.x, -force.y, -torque])
		settings["start_time"] = start_time
	if kind == Kind.RECORDED_PATH:
		settings["path"] = _table()
		settings["smooth"] = smooth
		settings["repeat"] = repeat
	if kind == Kind.RECORDED_PATH or kind == Kind.MOUSE:
		settings["stiffness"] = stiffness
		settings["rotation_stiffness"] = rotation_stiffness
		settings["damping_ratio"] = damping_ratio
		settings["max_force"] = max_force
		settings["max_torque"] = max_torque
	return settings


## What is wrong with it, beside figures out of range.
func get_problems() -> PackedStringArray:
	if kind == Kind.RECORDED_PATH and path.size() != path_times.size():
		return [
			(
				"The hand's path has %d points and %d times. Give each point its time."
				% [path.size(), path_times.size()]
			)
		]
	return []


func _table() -> PackedFloat64Array:
	var table := PackedFloat64Array()
	for i: int in mini(path.size(), path_times.size()):
		table.append_array([path_times[i], path[i].x, -path[i].y, -path[i].z])
	return table


func _validate_property(property: Dictionary) -> void:
	var belongs := true
	match property["name"]:
		&"stiffness", &"rotation_stiffness", &"damping_ratio", &"max_force", &"max_torque":
			belongs = kind == Kind.RECORDED_PATH or kind == Kind.MOUSE
		&"force", &"torque", &"start_time":
			belongs = kind == Kind.CONSTANT_FORCE
		&"path", &"path_times", &"smooth", &"repeat":
			belongs = kind == Kind.RECORDED_PATH
	if not belongs:
		property["usage"] = PROPERTY_USAGE_NO_EDITOR
