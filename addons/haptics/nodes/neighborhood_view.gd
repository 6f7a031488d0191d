@tool
extends Node2D
## Draws what the haptic loop knows of the scene: the region where it was looked for, around every
## link of what is held, and every convex piece of the last snapshot, in the color of who moves its
## body.

const _COLORS: Dictionary[String, Color] = {
	"fixed": Color(0.45, 0.66, 1.0),
	"kinematic": Color(1.0, 0.78, 0.3),
	"movable": Color(0.5, 0.9, 0.5),
}
const _ONE_WAY := Color(0.9, 0.5, 1.0)
const _REACH := Color(1.0, 1.0, 1.0, 0.35)
const _REGION := Color(0.55, 0.62, 0.8, 0.1)
const _CORNERS := 72
const _FILL := 0.3
# of a half-plane's edge, px
const _HALF_LENGTH := 4000.0

## The world to draw.
var world: HapticWorld2D


func _init() -> void:
	top_level = true
	z_index = 80
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF


## The view of `of`, made or removed as `shown` says; `now` is the one that is there.
static func shown_for(of: HapticWorld2D, now: Node2D, shown: bool) -> Node2D:
	if shown == (now != null):
		return now
	if not shown:
		now.queue_free()
		return null
	var view := new()
	view.world = of
	of.add_child(view, false, Node.INTERNAL_MODE_BACK)
	return view


func _process(_delta: float) -> void:
	queue_redraw()


func _draw() -> void:
	if world == null or not world.is_running():
		return
	_draw_region(world.get_reach())
	for piece: Dictionary in world.get_neighborhood():
		_draw_piece(piece)


# all discs as one region
func _draw_region(discs: Array[Vector3]) -> void:
	var regions: Array[PackedVector2Array] = []
	for disc: Vector3 in discs:
		var region := _circle(disc)
		var apart: Array[PackedVector2Array] = []
		for other: PackedVector2Array in regions:
			if Geometry2D.intersect_polygons(region, other).is_empty():
				apart.append(other)
				continue
			for part: PackedVector2Array in Geometry2D.merge_polygons(region, other):
				# holes are looked at from the discs around them
				if not Geometry2D.is_polygon_clockwise(part):
					region = part
		apart.append(region)
		regions = apart
	for region: PackedVector2Array in regions:
		if not Geometry2D.triangulate_polygon(region).is_empty():
			draw_colored_polygon(region, _REGION)
		draw_polyline(region + PackedVector2Array([region[0]]), _REACH, 1.5, true)


func _circle(disc: Vector3) -> PackedVector2Array:
	var points := PackedVector2Array()
	for i: int in _CORNERS:
		points.append(Vector2(disc.x, disc.y) + Vector2.from_angle(TAU * i / _CORNERS) * disc.z)
	return points


func _draw_piece(piece: Dictionary) -> void:
	var is_one_way: bool = piece["one_way"]
	var color := _ONE_WAY if is_one_way else _COLORS[piece["kind"]]
	var fill := Color(color, _FILL)
	var points: PackedVector2Array = piece["points"]
	var radius: float = piece["radius"]
	if piece["half_plane"] as bool:
		var along := (points[1] - points[0]).orthogonal().normalized() * _HALF_LENGTH
		draw_line(points[0] - along, points[0] + along, color, 2.0, true)
	elif points.size() == 1:
		draw_circle(points[0], radius, fill)
		draw_arc(points[0], radius, 0.0, TAU, 48, color, 1.0, true)
	elif points.size() == 2 and radius < 0.5:
		draw_line(points[0], points[1], color, 2.0, true)
	elif points.size() == 2:
		for outline: PackedVector2Array in Geometry2D.offset_polyline(
			points, radius, Geometry2D.JOIN_ROUND, Geometry2D.END_ROUND
		):
			_draw_outline(outline, color, fill)
	elif radius < 0.5:
		_draw_outline(points, color, fill)
	else:
		for outline: PackedVector2Array in Geometry2D.offset_polygon(
			points, radius, Geometry2D.JOIN_ROUND
		):
			_draw_outline(outline, color, fill)


func _draw_outline(outline: PackedVector2Array, color: Color, fill: Color) -> void:
	if outline.size() < 3:
		return
	if not Geometry2D.triangulate_polygon(outline).is_empty():
		draw_colored_polygon(outline, fill)
	draw_polyline(outline + PackedVector2Array([outline[0]]), color, 1.0, true)
