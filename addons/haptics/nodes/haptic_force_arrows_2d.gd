@tool
@icon("res://addons/haptics/icons/haptic_force_arrows_2d.svg")
class_name HapticForceArrows2D
extends Node2D
## Draws the forces of a haptic world as arrows: at every contact what pushes the tool, and at the
## grip what the hand feels.

const Warnings := preload("warnings.gd")
const DrawingChecks := preload("drawing_checks.gd")

## The world to draw; without one the world of this node's World2D.
@export var world: HapticWorld2D
## Length of an arrow, px/N.
@export_range(1.0, 200.0, 0.1, "or_greater", "suffix:px/N") var pixels_per_newton: float = 18.0
## Longest arrow, px.
@export_range(10.0, 500.0, 1.0, "or_greater", "suffix:px") var longest: float = 110.0
## Forces smaller than this are not drawn, N.
@export_range(0.0, 1.0, 0.001, "suffix:N") var threshold: float = 0.05
## Line width, px.
@export_range(0.5, 10.0, 0.1, "suffix:px") var width: float = 2.0
## Color of what pushes the tool.
@export var contact_color: Color = Color(1.0, 0.62, 0.36)
## Color of what the hand feels.
@export var hand_color: Color = Color(0.42, 0.86, 0.72)

var _warnings := Warnings.new(self, DrawingChecks.of_arrows.bind(self))


func _init() -> void:
	top_level = true
	z_index = 90
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF


func _notification(what: int) -> void:
	_warnings.follow(what)


func _process(_delta: float) -> void:
	if world == null and not Engine.is_editor_hint():
		world = HapticWorld2D.find_for(self)
	queue_redraw()


func _draw() -> void:
	if world == null or Engine.is_editor_hint() or not world.is_running():
		return
	if not DrawingChecks.figures_of_arrows(self).is_empty():
		_warnings.say()
		return
	for contact: HapticContact in world.get_contacts():
		_draw_arrow(contact.position, contact.force, contact_color)
	_draw_arrow(world.get_grip().origin, world.get_force(), hand_color)


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()


func _draw_arrow(from: Vector2, force: Vector2, color: Color) -> void:
	if force.length() < threshold:
		return
	var arrow := (force * pixels_per_newton).limit_length(longest)
	var along := arrow.normalized()
	var head := minf(4.5 * width, arrow.length())
	var tip := from + arrow
	var neck := tip - along * head
	var side := along.orthogonal() * head * 0.5
	draw_line(from, neck, color, width, true)
	draw_colored_polygon([tip, neck + side, neck - side] as PackedVector2Array, color)
