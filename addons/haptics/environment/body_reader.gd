@tool
extends RefCounted
## What the environment knows of one body; each kind of body has its own file beside this one.

const ShapeReader := preload("shape_reader.gd")
const SurfaceReader := preload("surface_reader.gd")

## Faster than this is a teleport, m/s.
const TELEPORT_SPEED := 5.0
## Slower than this stands still, m/s and rad/s.
const REST_SPEED := 1e-7

## The body read, always valid while this is in use.
var node: CollisionObject2D
## Its number on the native side, above 0.
var id: int
## Content of the last description that was handed over.
var signature := 0
## False while the native side refuses the description.
var is_usable := false
## Something it is made of changed since it was described.
var is_dirty := true
## What is wrong with it, from the last description.
var problems: PackedStringArray = []

var _units: HapticUnits
var _pose: PackedFloat64Array = []
var _velocity: PackedFloat64Array = [0.0, 0.0, 0.0]
var _tick := -1


func _init(body: CollisionObject2D, number: int, units: HapticUnits) -> void:
	node = body
	id = number
	_units = units


## Everything about the body that rarely changes, as the native side takes it.
func describe(fallback: HapticSurface) -> Dictionary:
	var reader := ShapeReader.new(_units)
	reader.read(node, scaling())
	problems = reader.problems
	return {
		"kind": kind(),
		"surface": SurfaceReader.find(node, fallback).to_settings(),
		"shapes": reader.shapes,
	}


## "fixed", "kinematic" or "movable".
func kind() -> String:
	return "fixed"


## Pose and velocity at tick number `tick`: x, y, angle, vx, vy, angular velocity.
func read_state(tick: int, seconds: float) -> PackedFloat64Array:
	_follow(tick, seconds)
	return _pose + _velocity


## Takes an impulse of the tool (N s, N s, N m s), seconds of game time a second of real time.
func take_impulse(_x: float, _y: float, _angular: float, _time_scale: float) -> void:
	pass


## Brings points from the node's axes to those without its scale.
func scaling() -> Transform2D:
	var whole := node.global_transform
	whole.origin = Vector2.ZERO
	return Transform2D(-whole.get_rotation(), Vector2.ZERO) * whole


# Godot reports no velocity for what a script moves, and the server's transform lags: difference.
func _follow(tick: int, seconds: float) -> void:
	var now := _read_pose()
	if _tick == tick - 1 and seconds > 0.0:
		for i: int in 3:
			_velocity[i] = (now[i] - _pose[i]) / seconds
		if Vector2(_velocity[0], _velocity[1]).length() > TELEPORT_SPEED:
			_velocity.fill(0.0)
	elif _tick != tick:
		_velocity.fill(0.0)
	_pose = now
	_tick = tick


# the angle is kept free of jumps from +pi to -pi
func _read_pose() -> PackedFloat64Array:
	var now := _units.pose_to_meters(node.global_transform)
	if not _pose.is_empty():
		now[2] = _pose[2] + angle_difference(_pose[2], now[2])
	return now
