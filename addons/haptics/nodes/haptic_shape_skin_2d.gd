@tool
@icon("res://addons/haptics/icons/haptic_shape_skin_2d.svg")
class_name HapticShapeSkin2D
extends Node2D
## Paints the collision shapes of its parent: a quick look for walls, objects and tools.
##
## Replace it with sprites when the scene gets its own.

const Warnings := preload("warnings.gd")
const DrawingChecks := preload("drawing_checks.gd")

# of a half-plane's edge, px
const _HALF_LENGTH := 4000.0

## Color inside.
@export var fill: Color = Color(0.553, 0.647, 0.953, 0.45):
	set(value):
		fill = value
		queue_redraw()
## Color of the edge.
@export var edge: Color = Color(0.62, 0.71, 1.0):
	set(value):
		edge = value
		queue_redraw()
## Width of the edge, px; it lies inside.
@export_range(0.0, 10.0, 0.1, "suffix:px") var edge_width: float = 1.5:
	set(value):
		edge_width = value
		queue_redraw()
## A line from the parent's origin, which shows how it turns; its length, px.
@export_range(0.0, 200.0, 1.0, "suffix:px") var pointer: float = 0.0:
	set(value):
		pointer = value
		queue_redraw()

var _warnings := Warnings.new(self, DrawingChecks.of_skin.bind(self))


func _notification(what: int) -> void:
	_warnings.follow(what)


func _process(_delta: float) -> void:
	# shapes are edited
	if Engine.is_editor_hint():
		queue_redraw()
	else:
		set_process(false)


func _draw() -> void:
	if not DrawingChecks.figures_of_skin(self).is_empty():
		_warnings.say()
		return
	for child: Node in get_parent().get_children():
		var shape := child as CollisionShape2D
		var polygon := child as CollisionPolygon2D
		if shape != null and shape.shape != null and not shape.disabled:
			_paint(_outline(shape.shape), shape.transform)
			_paint_lines(_lines(shape.shape), shape.transform)
		elif polygon != null and not polygon.disabled:
			_paint(polygon.polygon, polygon.transform)
	if pointer > 0.0:
		draw_line(Vector2.ZERO, Vector2(pointer, 0.0), edge, edge_width, true)
		draw_circle(Vector2.ZERO, 2.2 * edge_width, edge, true, -1.0, true)


func _paint(outline: PackedVector2Array, place: Transform2D) -> void:
	if outline.size() < 3:
		return
	var corners := place * outline
	if Geometry2D.triangulate_polygon(corners).is_empty():
		# it crosses itself: its edges alone
		for i: int in outline.size():
			_paint_lines([outline[i], outline[(i + 1) % outline.size()]], place)
		return
	draw_colored_polygon(corners, fill)
	if edge.a > 0.0 and edge_width > 0.0:
		var rim := Geometry2D.offset_polygon(corners, -edge_width / 2.0)
		for ring: PackedVector2Array in rim:
			ring.append(ring[0])
			draw_polyline(ring, edge, edge_width, true)


# pairs of ends
func _paint_lines(ends: PackedVector2Array, place: Transform2D) -> void:
	if ends.size() < 2 or edge.a <= 0.0 or edge_width <= 0.0:
		return
	var placed := place * ends
	for i: int in range(0, placed.size() - 1, 2):
		draw_line(placed[i], placed[i + 1], edge, edge_width, true)


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()


# what has no inside, as pairs of ends
static func _lines(shape: Shape2D) -> PackedVector2Array:
	if shape is SegmentShape2D:
		return [(shape as SegmentShape2D).a, (shape as SegmentShape2D).b]
	if shape is ConcavePolygonShape2D:
		return (shape as ConcavePolygonShape2D).segments
	if shape is WorldBoundaryShape2D:
		var boundary := shape as WorldBoundaryShape2D
		var middle := boundary.normal * boundary.distance
		var along := boundary.normal.orthogonal().normalized() * _HALF_LENGTH
		return [middle - along, middle + along]
	return []


static func _outline(shape: Shape2D) -> PackedVector2Array:
	if shape is RectangleShape2D:
		var half := (shape as RectangleShape2D).size / 2.0
		return [-half, Vector2(half.x, -half.y), half, Vector2(-half.x, half.y)]
	if shape is CircleShape2D:
		return _arc(Vector2.ZERO, (shape as CircleShape2D).radius, 0.0, TAU)
	if shape is CapsuleShape2D:
		var capsule := shape as CapsuleShape2D
		var reach := Vector2(0.0, capsule.height / 2.0 - capsule.radius)
		return _arc(reach, capsule.radius, 0.0, PI) + _arc(-reach, capsule.radius, PI, TAU)
	if shape is ConvexPolygonShape2D:
		return (shape as ConvexPolygonShape2D).points
	return []


static func _arc(center: Vector2, radius: float, from: float, to: float) -> PackedVector2Array:
	var points := PackedVector2Array()
	for i: int in 33:
		points.append(center + Vector2.from_angle(lerpf(from, to, i / 32.0)) * radius)
	return points
