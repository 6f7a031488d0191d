@tool
extends RefCounted
## What the environment knows of one body; each kind of body has its own file beside this one.

const Gateway := preload("../nodes/gateway.gd")
const ShapeReader := preload("shape_reader.gd")
const SurfaceReader := preload("surface_reader.gd")

## Faster than this is a teleport, m/s.
const TELEPORT_SPEED := 5.0
## Slower than this stands still, m/s and rad/s.
const REST_SPEED := 1e-7

# a shape whose corners moved farther at once is another one, m: 3 N on the paper's wall
const _EXCHANGED := 0.0002
# a scale that is off by less is noise of single precision, and no reason to read the shapes again
const _SCALE_STEP := Vector2(1e-5, 1e-5)

## The body read; may be gone, see is_present().
var node: Node2D
## Its number on the native side, above 0.
var id: int
## Its earlier numbers, the first one first.
var numbers: Array[int] = []
## For so many ticks the engine has not found it.
var missed := 0
## Content of the last description that was handed over.
var signature := 0
## False while the native side refuses the description.
var is_usable := false
## Something it is made of changed since it was described.
var is_dirty := true
## What is wrong with it, from the last description.
var problems: PackedStringArray = []
## Distance from the node's origin to the farthest point of its shapes, m, from the last
## description.
var extent := 0.0

var _units: HapticUnits
var _told_shapes: Array[Dictionary] = []
# x, y, angle, vx, vy, angular velocity, free fall x, y
var _state: PackedFloat64Array = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
var _tick := -1
# stood where it stands at the tick before
var _rests := false
var _print := 0
var _seen_at := Transform2D()
var _seen_frame := -1


func _init(body: Node2D, number: int, units: HapticUnits) -> void:
	node = body
	id = number
	_units = units


## True while its node lives in a scene.
func is_present() -> bool:
	return is_instance_valid(node) and node.is_inside_tree()


## Everything about the body that rarely changes, as the native side takes it.
func describe(fallback: HapticSurface) -> Dictionary:
	var reader := ShapeReader.new(_units)
	_read_shapes(reader)
	problems = reader.problems
	extent = reader.extent()
	var description := {
		"kind": kind(),
		"surface": surface(fallback).to_settings(),
		"shapes": reader.shapes,
		"layer": _layer(),
	}
	if node is PhysicsBody2D:
		description["mask"] = (node as PhysicsBody2D).collision_mask
	if is_finite(_friction()):
		description["scene_friction"] = _friction()
	return description


## The number under which the scene knows it, also after it was numbered anew.
func first_number() -> int:
	return id if numbers.is_empty() else numbers[0]


## Whether `shapes` are others than those that were told last, and not the same ones a little
## larger, or moved by a little. They are told from now on.
func exchanges_shapes(shapes: Array[Dictionary]) -> bool:
	var before := _told_shapes
	_told_shapes = shapes
	if before.size() != shapes.size():
		return not before.is_empty()
	for i: int in shapes.size():
		var was: PackedFloat64Array = before[i]["points"]
		var now: PackedFloat64Array = shapes[i]["points"]
		if before[i]["id"] != shapes[i]["id"] or was.size() != now.size():
			return true
		for k: int in now.size():
			if absf(now[k] - was[k]) > _EXCHANGED:
				return true
	return false


## True while all of its shapes are switched off: then nothing is there to touch, and nothing wrong.
func is_switched_off() -> bool:
	var body := node as CollisionObject2D
	if body == null or body.get_shape_owners().is_empty():
		return false
	for owner_id: int in body.get_shape_owners():
		if not body.is_shape_owner_disabled(owner_id):
			return false
	return true


## How it feels.
func surface(fallback: HapticSurface) -> HapticSurface:
	return SurfaceReader.find(node, fallback)


## The resources it is made of, whose changes matter.
func parts(fallback: HapticSurface) -> Array[Resource]:
	var found: Array[Resource] = [surface(fallback)]
	var body := node as CollisionObject2D
	if body == null:
		return found
	for owner_id: int in body.get_shape_owners():
		for index: int in body.shape_owner_get_shape_count(owner_id):
			found.append(body.shape_owner_get_shape(owner_id, index))
	return found


## Marks the body when something that has no signal changed: a shape that was added, moved, switched
## off or exchanged, another surface, another scale.
func look() -> void:
	var now := _features().hash()
	if now != _print:
		_print = now
		is_dirty = true


## "fixed", "kinematic" or "movable".
func kind() -> String:
	return "fixed"


## Pose and velocity at tick number `tick`: x, y, angle, vx, vy, angular velocity, and with what
## acceleration it falls where nothing holds it: x, y. Not to be changed.
func read_state(tick: int, seconds: float) -> PackedFloat64Array:
	var at := node.global_transform
	# most bodies rest at most ticks
	if at == _seen_at and _seen_frame == _units.frame:
		if not _rests:
			_set_velocity(0.0, 0.0, 0.0)
			_rests = true
	else:
		_follow(at, tick, seconds)
	_tick = tick
	return _state


## Takes an impulse of the tool (N s, N s, N m s), seconds of game time a second of real time.
func take_impulse(_x: float, _y: float, _angular: float, _time_scale: float) -> void:
	pass


## Tells the native side what else it is, at every tick after its description.
func tie(_native: Gateway) -> void:
	pass


## Brings points from the node's axes to those without its scale.
func scaling() -> Transform2D:
	var whole := node.global_transform
	whole.origin = Vector2.ZERO
	var left := Transform2D(-whole.get_rotation(), Vector2.ZERO) * whole
	left.x = left.x.snapped(_SCALE_STEP)
	left.y = left.y.snapped(_SCALE_STEP)
	return left


func _read_shapes(reader: ShapeReader) -> void:
	reader.read(node as CollisionObject2D, scaling())


# layers that it is on
func _layer() -> int:
	return (node as CollisionObject2D).collision_layer


# friction in the engine's own contacts; not a number for what the engine does not solve
func _friction() -> float:
	var body := node as PhysicsBody2D
	if body == null:
		return NAN
	return PhysicsServer2D.body_get_param(body.get_rid(), PhysicsServer2D.BODY_PARAM_FRICTION)


# what the description depends on
func _features() -> Array:
	var own := SurfaceReader.find_own(node)
	var features: Array = [kind(), scaling(), own.get_instance_id() if own != null else 0]
	var body := node as CollisionObject2D
	features.append_array([body.collision_layer, body.collision_mask, _friction()])
	for owner_id: int in body.get_shape_owners():
		features.append(owner_id)
		features.append(body.is_shape_owner_disabled(owner_id))
		features.append(body.is_shape_owner_one_way_collision_enabled(owner_id))
		features.append(body.shape_owner_get_transform(owner_id))
		for index: int in body.shape_owner_get_shape_count(owner_id):
			features.append(body.shape_owner_get_shape(owner_id, index).get_instance_id())
	return features


# Godot reports no velocity for what a script moves, and the server's transform lags: difference.
func _follow(at: Transform2D, tick: int, seconds: float) -> void:
	var is_next := _tick == tick - 1 and seconds > 0.0
	var x := _state[0]
	var y := _state[1]
	var angle := _state[2]
	_place(at)
	if is_next:
		_set_velocity(
			(_state[0] - x) / seconds, (_state[1] - y) / seconds, (_state[2] - angle) / seconds
		)
	if not is_next or Vector2(_state[3], _state[4]).length() > TELEPORT_SPEED:
		_set_velocity(0.0, 0.0, 0.0)
	_rests = false


# the angle is kept free of jumps from +pi to -pi
func _place(at: Transform2D) -> void:
	var now := _units.pose_to_meters(at)
	_state[0] = now[0]
	_state[1] = now[1]
	_state[2] = now[2] if _seen_frame < 0 else _state[2] + angle_difference(_state[2], now[2])
	_seen_at = at
	_seen_frame = _units.frame


func _set_velocity(x: float, y: float, angular: float) -> void:
	_state[3] = x
	_state[4] = y
	_state[5] = angular
