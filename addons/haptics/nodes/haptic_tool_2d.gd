@tool
@icon("res://addons/haptics/icons/haptic_tool_2d.svg")
class_name HapticTool2D
extends Area2D
## What the user holds: a rigid body that the haptic loop moves, felt wherever it touches something.
##
## Its CollisionShape2D and CollisionPolygon2D children are its shape, its collision_mask selects
## what it touches. The node follows the loop's newest report; do not move it while the world runs.
## All signals come on the main thread, in time order.

## The tool began to touch a body, the one of `contact`.
signal contact_began(contact: HapticContact)
## The tool no longer touches the body of `contact`, which is null when the body is gone. Comes
## once for every contact_began, also when the world stops.
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
const Sketch := preload("tool_sketch.gd")

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
var _sketch := Sketch.new(self)


func _init() -> void:
	# the loop's report places it, and Godot's areas need not look at it
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF


func _notification(what: int) -> void:
	if what == NOTIFICATION_ENTER_TREE:
		add_to_group(HapticWorld2D.TOOLS)
	_warnings.follow(what)
	_sketch.follow(what)


## The world it belongs to; null without one.
func get_haptic_world() -> HapticWorld2D:
	return HapticWorld2D.find_for(self)


## True while `body` is touched; without one, while anything is.
func is_touching(body: Node2D = null) -> bool:
	if body == null:
		return not get_contacts().is_empty()
	return not get_contacts_with(body).is_empty()


## Where the tool touches something now. At most 16, in a fixed order; newest report of the loop.
func get_contacts() -> Array[HapticContact]:
	var world := get_haptic_world()
	if world == null or world.get_tool() != self:
		return []
	return world.get_contacts()


## Where the tool touches `body` now.
func get_contacts_with(body: Node2D) -> Array[HapticContact]:
	return get_contacts().filter(func(c: HapticContact) -> bool: return c.body == body)


## What is touched now, each once.
func get_touched_bodies() -> Array[Node2D]:
	var bodies: Array[Node2D] = []
	for contact: HapticContact in get_contacts():
		if contact.body != null and not contact.body in bodies:
			bodies.append(contact.body)
	return bodies


## Force of `body` on the tool, N, in the canvas's axes.
func get_force_from(body: Node2D) -> Vector2:
	var force := Vector2.ZERO
	for contact: HapticContact in get_contacts_with(body):
		force += contact.force
	return force


## Deepest overlap with `body`, m; 0 when it is not touched.
func get_penetration_of(body: Node2D) -> float:
	var deepest := 0.0
	for contact: HapticContact in get_contacts_with(body):
		deepest = maxf(deepest, contact.penetration)
	return deepest


## Whose shapes are its shapes: a body in the hand has a tool that stands for it.
func get_shape_source() -> CollisionObject2D:
	return self


## Pushes an error for every problem of this tool that was not told before.
func tell_problems() -> void:
	_warnings.say()


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
