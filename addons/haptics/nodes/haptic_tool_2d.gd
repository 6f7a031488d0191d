@tool
@icon("res://addons/haptics/icons/haptic_tool_2d.svg")
class_name HapticTool2D
extends Area2D
## What the user holds: a rigid body that the haptic loop moves, felt wherever it touches something.
##
## Its CollisionShape2D and CollisionPolygon2D children are its shape, its collision_mask selects
## what it touches. The node follows the loop's newest report; do not move it while the world runs.
## All signals come on the main thread, in time order.

## A contact closed.
signal contact_began(contact: HapticContact)
## A contact opened.
signal contact_ended(contact: HapticContact)
## A contact closed with a collision; `impulse` in N s.
signal impacted(contact: HapticContact, impulse: float)
## A contact that stuck began to slide.
signal slip_began(contact: HapticContact)

## How the hand holds the tool.
enum Grip {
	## Position and angle.
	POSE,
	## One point, about which the tool turns freely.
	POINT,
}

const Warnings := preload("warnings.gd")
const Checks := preload("checks.gd")

## Mass of the tool, kg, above 0.
@export_range(0.001, 2.0, 0.001, "or_greater", "suffix:kg") var mass: float = 0.1
## Moment of inertia about the center of mass, kg m²; 0 computes it from the shapes.
@export_range(0.0, 0.01, 0.0000001, "or_greater", "suffix:kg m²") var inertia: float = 0.0
## Center of mass in the node's axes.
@export_custom(PROPERTY_HINT_NONE, "suffix:px") var center_of_mass: Vector2 = Vector2.ZERO
## Surface of the tool itself; without one it feels as what it touches.
@export var surface: HapticSurface
## Radius by which corners are rounded, m, 0 or more.
@export_range(0.0, 0.005, 0.0001, "or_greater", "suffix:m") var rounding: float = 0.0

@export_group("Grip")
## How the hand holds the tool.
@export var grip: Grip = Grip.POSE
## Where the hand holds it, in the node's axes.
@export_custom(PROPERTY_HINT_NONE, "suffix:px") var grip_point: Vector2 = Vector2.ZERO

var _warnings := Warnings.new(self, Checks.of_tool.bind(self))


func _init() -> void:
	# the loop's report places it, and Godot's areas need not look at it
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF


func _notification(what: int) -> void:
	if what == NOTIFICATION_ENTER_TREE:
		add_to_group(HapticWorld2D.TOOLS)
	_warnings.follow(what)


## The world it belongs to; null without one.
func get_haptic_world() -> HapticWorld2D:
	return HapticWorld2D.find_for(self)


## True while something is touched.
func is_touching() -> bool:
	var world := get_haptic_world()
	return world != null and world.get_tool() == self and not world.get_contacts().is_empty()


## Pushes an error for every problem of this tool that was not told before.
func tell_problems() -> void:
	_warnings.say()


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
