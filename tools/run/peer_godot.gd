extends SceneTree
## The box of native/bench/peers_report.cpp in Godot's own 2D physics, as rows of peers_godot.csv.
##
##   godot --headless --fixed-fps 500 --path . -s tools/run/peer_godot.gd -- FILE
##
## Time is that of the whole main loop a tick, less the same without bodies.

const Table := preload("res://tools/run/csv_table.gd")

const _COLUMNS: PackedStringArray = [
	"scene", "way", "setup", "deepest_m", "behind_hand_m", "ns_per_step", "ns_low", "ns_high"
]
const _RATE := 500
const _PIXELS := 4000.0
const _TICKS := 2000
const _HALF := Vector2(0.01, 0.02)
const _MASS := 0.3
const _INERTIA := 0.3 * (0.01 * 0.01 + 0.02 * 0.02) / 3.0
const _PLAY := 5e-5
const _HALF_WALL := 0.05
# empty, peg, wall
const _PARTS := 3

var _part := -1
var _tick := 0
var _began := 0
var _empty_ns := 0.0
var _body: RigidBody2D
var _root: Node2D
# x, y, half x, half y, m, y up
var _fixed: Array[Vector4] = []
var _deepest := 0.0
var _behind := 0.0
var _table: Table


func _initialize() -> void:
	Engine.physics_ticks_per_second = _RATE
	var arguments := OS.get_cmdline_user_args()
	if arguments.size() != 1:
		printerr("peer_godot: give the file to write")
		quit(1)
		return
	_table = Table.new(arguments[0], _COLUMNS)
	_next()


func _physics_process(_delta: float) -> bool:
	if _table == null or _part >= _PARTS:
		return true
	if _tick > 0 and _body != null:
		_look()
	if _tick == _TICKS:
		_close()
		return _part >= _PARTS
	if _body != null:
		_push(_tick / float(_RATE))
	_tick += 1
	return false


func _next() -> void:
	_part += 1
	_tick = 0
	_deepest = 0.0
	_behind = 0.0
	_fixed.clear()
	if _root != null:
		_root.free()
	_root = null
	_body = null
	if _part == 1:
		for side: float in [1.0, -1.0]:
			var x := side * (_HALF.x + _PLAY + _HALF_WALL)
			_fixed.append(Vector4(x, -_HALF_WALL, _HALF_WALL, _HALF_WALL))
		_make(-0.02)
	elif _part == 2:
		_fixed.append(Vector4(0.0, -0.05, 0.2, 0.05))
		_make(_HALF.y + 0.01)
	_began = Time.get_ticks_usec()


func _make(height: float) -> void:
	_root = Node2D.new()
	var matter := PhysicsMaterial.new()
	matter.friction = 0.0
	for box: Vector4 in _fixed:
		var wall := StaticBody2D.new()
		wall.physics_material_override = matter
		wall.position = _PIXELS * Vector2(box.x, -box.y)
		wall.add_child(_shape(Vector2(box.z, box.w)))
		_root.add_child(wall)
	_body = RigidBody2D.new()
	_body.physics_material_override = matter
	_body.mass = _MASS
	_body.inertia = _INERTIA * _PIXELS * _PIXELS
	_body.gravity_scale = 0.0
	_body.can_sleep = false
	_body.linear_damp_mode = RigidBody2D.DAMP_MODE_REPLACE
	_body.angular_damp_mode = RigidBody2D.DAMP_MODE_REPLACE
	_body.linear_damp = 0.0
	_body.angular_damp = 0.0
	_body.continuous_cd = RigidBody2D.CCD_MODE_CAST_SHAPE
	_body.position = _PIXELS * Vector2(0.0, -height)
	_body.add_child(_shape(_HALF))
	_root.add_child(_body)
	root.add_child(_root)


static func _shape(half: Vector2) -> CollisionShape2D:
	var shape := CollisionShape2D.new()
	var box := RectangleShape2D.new()
	box.size = 2.0 * _PIXELS * half
	shape.shape = box
	return shape


# x, y up, angle counter-clockwise
func _target(time: float) -> Vector3:
	if _part == 1:
		return Vector3(
			1e-3 * sin(20.0 * time), -0.05 + 0.03 * cos(3.0 * time), 0.01 * sin(13.0 * time)
		)
	return Vector3(0.01 * sin(3.0 * time), _HALF.y - 0.004 + 0.014 * cos(6.0 * time), 0.0)


func _pose() -> Vector3:
	var at := _body.global_position / _PIXELS
	return Vector3(at.x, -at.y, -_body.global_rotation)


func _push(time: float) -> void:
	var away := _target(time) - _pose()
	var speed := _body.linear_velocity / _PIXELS
	var force := Vector2(1000.0 * away.x - 20.0 * speed.x, 1000.0 * away.y + 20.0 * speed.y)
	_body.apply_central_force(_PIXELS * Vector2(force.x, -force.y))
	var torque := away.z + 0.01 * _body.angular_velocity
	_body.apply_torque(-torque * _PIXELS * _PIXELS)


func _look() -> void:
	var pose := _pose()
	var c := absf(cos(pose.z))
	var s := absf(sin(pose.z))
	for box: Vector4 in _fixed:
		var gap := Vector2(pose.x - box.x, pose.y - box.y)
		var turned := gap.rotated(-pose.z).abs()
		var least := minf(
			minf(
				box.z + c * _HALF.x + s * _HALF.y - absf(gap.x),
				box.w + s * _HALF.x + c * _HALF.y - absf(gap.y)
			),
			minf(
				_HALF.x + c * box.z + s * box.w - turned.x,
				_HALF.y + s * box.z + c * box.w - turned.y
			)
		)
		_deepest = maxf(_deepest, least)
	var goal := _target((_tick - 1) / float(_RATE))
	_behind = maxf(_behind, absf(pose.y - goal.y) if _part == 1 else absf(pose.x - goal.x))


func _close() -> void:
	var ns := 1000.0 * (Time.get_ticks_usec() - _began) / _TICKS
	if _part == 0:
		_empty_ns = ns
	else:
		var step := ns - _empty_ns
		var scenes: PackedStringArray = [
			"peg in a hole, 100 um clearance, 500 Hz", "struck and pressed wall, 500 Hz"
		]
		var version: String = Engine.get_version_info()["string"]
		(
			_table
			. add(
				{
					"scene": scenes[_part - 1],
					"way": "godot's own physics",
					"setup":
					"Godot %s, 4000 px/m, 500 ticks a second, cast shapes, no damping" % version,
					"deepest_m": _deepest,
					"behind_hand_m": _behind,
					"ns_per_step": step,
					"ns_low": step,
					"ns_high": step,
				}
			)
		)
	_next()
	if _part == _PARTS:
		var written := _table.write()
		quit(0 if written else 1)
