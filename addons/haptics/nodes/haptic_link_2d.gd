@tool
@icon("res://addons/haptics/icons/haptic_link_2d.svg")
class_name HapticLink2D
extends HapticTool2D
## One link of a [HapticLinkage2D]: a rigid part with a joint at its origin.
##
## Nest links: the joint ties a link to the link above it, or to the scene when it stands directly
## below the linkage. The pose in the editor is coordinate 0. Shapes, mask, surface, mass and center
## of mass are as for every tool; while the linkage is held, what any of its links touches is felt,
## and the signals come from the link that is held.

## How a link moves against the one above it.
enum Joint {
	## Turns about the link's origin.
	REVOLUTE,
	## Slides along the link's x axis.
	PRISMATIC,
	## Does not move: both are one part.
	FIXED,
}

const _STATE := &"joint_state"

## Mass per area of the shapes, kg/m²; above 0 it replaces [member mass].
@export_range(0.0, 100.0, 0.1, "or_greater", "suffix:kg/m²") var density: float = 0.0
## The hand holds the angle too. Else it holds the point [member grip_point], and the link turns
## freely about it, as far as its joints let it.
@export var hold_angle: bool = false

@export_group("Joint")
## How it moves against the link above it.
@export var joint: Joint = Joint.REVOLUTE:
	set(value):
		joint = value
		notify_property_list_changed()
## The joint has limits.
@export var has_limits: bool = false:
	set(value):
		has_limits = value
		notify_property_list_changed()
## Lower limit of the coordinate, rad (clockwise) or m.
@export_range(-6.3, 6.3, 0.0001, "or_less", "or_greater") var lower_limit: float = -1.0
## Upper limit of the coordinate, rad (clockwise) or m.
@export_range(-6.3, 6.3, 0.0001, "or_less", "or_greater") var upper_limit: float = 1.0
## Spring of the limits, N m/rad or N/m; 0 makes them as hard as a wall.
@export_range(0.0, 1000.0, 0.01, "or_greater") var limit_stiffness: float = 0.0
## Damper of the limits, N m s/rad or N s/m.
@export_range(0.0, 10.0, 0.0001, "or_greater") var limit_damping: float = 0.0
## Viscous damping of the joint, N m s/rad or N s/m.
@export_range(0.0, 1.0, 0.00001, "or_greater") var joint_damping: float = 0.0
## Dry friction of the joint, N m or N.
@export_range(0.0, 1.0, 0.0001, "or_greater") var joint_friction: float = 0.0
## Spring of the joint, N m/rad or N/m.
@export_range(0.0, 10.0, 0.0001, "or_greater") var spring_stiffness: float = 0.0
## Coordinate at which the spring rests, rad (clockwise) or m.
@export_range(-6.3, 6.3, 0.0001, "or_less", "or_greater") var spring_rest: float = 0.0

# of what it is a copy of, until its linkage asked for it
var _copied: Array = []


## The linkage it belongs to; null when it is not below one.
func get_linkage() -> HapticLinkage2D:
	var above := get_parent()
	while above is HapticLink2D:
		above = above.get_parent()
	return above as HapticLinkage2D


## The link above it; null when its joint ties it to the scene.
func get_parent_link() -> HapticLink2D:
	return get_parent() as HapticLink2D


## Coordinate of its joint now: rad (clockwise) or m, 0 where the scene drew it.
func get_coordinate() -> float:
	var linkage := get_linkage()
	return linkage.get_coordinate(self) if linkage != null else 0.0


## Where what it is a copy of was drawn, its coordinate and rate; once, and empty for no copy.
func take_copied_state() -> Array:
	var state := _copied
	_copied = []
	return state


# stored in copies and saved scenes of a running game, not in the editor's
func _get_property_list() -> Array[Dictionary]:
	if Engine.is_editor_hint():
		return []
	return [{"name": _STATE, "type": TYPE_ARRAY, "usage": PROPERTY_USAGE_STORAGE}]


func _get(property: StringName) -> Variant:
	if property != _STATE:
		return null
	return get_linkage().get_joint_state(self) if get_linkage() != null else []


func _set(property: StringName, value: Variant) -> bool:
	if property == _STATE and value is Array:
		_copied = value
	return property == _STATE


## Pushes an error for every problem of it and its linkage that was not told before.
func tell_problems() -> void:
	super.tell_problems()
	if get_linkage() != null:
		get_linkage().tell_problems()


func _validate_property(property: Dictionary) -> void:
	var name_of: StringName = property["name"]
	var unused := name_of == &"grip"
	if joint == Joint.FIXED:
		unused = unused or name_of.begins_with("joint_") or name_of.begins_with("spring_")
		unused = unused or name_of == &"has_limits"
	if joint == Joint.FIXED or not has_limits:
		unused = unused or "limit" in name_of and name_of != &"has_limits"
	if unused:
		property["usage"] = (property["usage"] as int) & ~PROPERTY_USAGE_EDITOR
