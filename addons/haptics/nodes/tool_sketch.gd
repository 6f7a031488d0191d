@tool
extends RefCounted
## Draws into the editor what the shapes of a tool or link do not show: where the hand holds it, its
## center of mass, and of a link its joint with its limits, in the pose in which it was drawn.

const PlaceChecks := preload("place_checks.gd")

const _JOINT := Color(1.0, 0.78, 0.3)
const _GRIP := Color(0.42, 0.86, 0.72)
const _MASS := Color(0.91, 0.93, 0.97)
const _WIDTH := 1.5
# px
const _RING := 8.0
const _ARC := 42.0
const _TICK := 7.0
const _ARROW := 30.0
const _FAR := 4000.0

var _tool: HapticTool2D
var _drawn := 0


func _init(tool: HapticTool2D) -> void:
	_tool = tool


## For the node's _notification(): scripts that extend the node cannot lose it.
func follow(what: int) -> void:
	if not Engine.is_editor_hint():
		return
	match what:
		Node.NOTIFICATION_ENTER_TREE:
			_tool.get_tree().process_frame.connect(_look)
		Node.NOTIFICATION_EXIT_TREE:
			_tool.get_tree().process_frame.disconnect(_look)
		CanvasItem.NOTIFICATION_DRAW:
			_draw()


func _look() -> void:
	var link := _tool as HapticLink2D
	var figures: Array = [_tool.grip_point, _tool.center_of_mass, _tool.mass]
	if link != null:
		figures.append_array([link.joint, link.has_limits, link.lower_limit, link.upper_limit])
		figures.append_array([_is_grounded(link), _floats(link), _pixels_per_meter()])
	var now := figures.hash()
	if now != _drawn:
		_drawn = now
		_tool.queue_redraw()


func _draw() -> void:
	var link := _tool as HapticLink2D
	if link != null and link.get_linkage() != null and not _floats(link):
		_draw_joint(link)
	var mass := _tool.center_of_mass
	if mass.is_finite():
		_tool.draw_arc(mass, 4.0, 0.0, TAU, 16, _MASS, _WIDTH, true)
		_tool.draw_line(mass - Vector2(4, 0), mass + Vector2(4, 0), _MASS, _WIDTH, true)
		_tool.draw_line(mass - Vector2(0, 4), mass + Vector2(0, 4), _MASS, _WIDTH, true)
	var grip := _tool.grip_point
	if grip.is_finite() and (link == null or _is_held_first(link)):
		_tool.draw_arc(grip, _RING, 0.0, TAU, 24, _GRIP, 2.0, true)
		_tool.draw_circle(grip, 2.5, _GRIP, true, -1.0, true)


func _draw_joint(link: HapticLink2D) -> void:
	if _is_grounded(link):
		_draw_ground()
	match link.joint:
		HapticLink2D.Joint.REVOLUTE:
			_tool.draw_arc(Vector2.ZERO, _RING, 0.0, TAU, 24, _JOINT, 2.0, true)
			if link.has_limits and link.lower_limit < link.upper_limit:
				_draw_arc(link.lower_limit, link.upper_limit)
		HapticLink2D.Joint.PRISMATIC:
			var box := Rect2(-_RING, -_RING * 0.6, 2.0 * _RING, 1.2 * _RING)
			_tool.draw_rect(box, _JOINT, false, 2.0, true)
			_draw_way(link)
		HapticLink2D.Joint.FIXED:
			for side: float in [-1.0, 1.0]:
				var corner := Vector2(_RING, side * _RING) * 0.7
				_tool.draw_line(-corner, corner, _JOINT, 2.0, true)


# the x axis stands at coordinate 0
func _draw_arc(from: float, to: float) -> void:
	var least := maxf(from, -TAU)
	var most := minf(to, TAU)
	_tool.draw_arc(Vector2.ZERO, _ARC, least, most, 48, Color(_JOINT, 0.7), _WIDTH, true)
	for angle: float in [least, most]:
		var along := Vector2.from_angle(angle)
		_tool.draw_line(along * (_ARC - _TICK), along * (_ARC + _TICK), _JOINT, 2.0, true)


# from stop to stop, or an arrow both ways
func _draw_way(link: HapticLink2D) -> void:
	if link.has_limits and link.lower_limit < link.upper_limit:
		var scale := _pixels_per_meter()
		var ends: Array[float] = [
			maxf(link.lower_limit * scale, -_FAR), minf(link.upper_limit * scale, _FAR)
		]
		var first := Vector2(ends[0], -2.0 * _RING)
		var last := Vector2(ends[1], -2.0 * _RING)
		_tool.draw_line(first, last, Color(_JOINT, 0.7), _WIDTH, true)
		for end: Vector2 in [first, last]:
			_tool.draw_line(end - Vector2(0, _TICK), end + Vector2(0, _TICK), _JOINT, 2.0, true)
		return
	for side: float in [-1.0, 1.0]:
		var tip := Vector2(side * _ARROW, 0.0)
		_tool.draw_line(Vector2(side * _RING, 0.0), tip, _JOINT, _WIDTH, true)
		for way: float in [-1.0, 1.0]:
			_tool.draw_line(tip, tip - Vector2(side * 6.0, way * 4.0), _JOINT, _WIDTH, true)


# hatched, as in drawings of mechanisms
func _draw_ground() -> void:
	var under := 1.8 * _RING
	_tool.draw_line(Vector2(0, _RING), Vector2(0, under), _JOINT, _WIDTH, true)
	_tool.draw_line(Vector2(-14, under), Vector2(14, under), _JOINT, 2.0, true)
	for i: int in 5:
		var top := Vector2(-12.0 + 6.0 * i, under)
		_tool.draw_line(top, top + Vector2(-5, 6), _JOINT, 1.0, true)


func _is_grounded(link: HapticLink2D) -> bool:
	var linkage := link.get_linkage()
	return linkage != null and linkage.grounded and link.get_parent_link() == null


# its first link has no joint that means anything
func _floats(link: HapticLink2D) -> bool:
	var linkage := link.get_linkage()
	return linkage != null and not linkage.grounded and link.get_parent_link() == null


func _is_held_first(link: HapticLink2D) -> bool:
	var linkage := link.get_linkage()
	return linkage != null and linkage.get_start_link() == link


func _pixels_per_meter() -> float:
	var world := HapticWorld2D.find_for(_tool)
	return world.pixels_per_meter if world != null and PlaceChecks.can_measure(world) else 4000.0
