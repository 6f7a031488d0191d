@tool
extends HapticTool2D
## A RigidBody2D in the hand: stands for it in the loop. While it is held Godot has the body frozen,
## on no layer and with no mask; when the hand lets go Godot gets it back with its velocity.

const MovableBody := preload("../environment/movable_body.gd")
const SurfaceReader := preload("../environment/surface_reader.gd")

## The body that is held.
var body: RigidBody2D

var _layer := 0
var _mask := 0
var _freeze := false
var _freeze_mode := RigidBody2D.FREEZE_MODE_STATIC
var _is_frozen := false


## `at` in the body's axes, px.
func stand_for(what: RigidBody2D, at: Vector2, units: HapticUnits) -> void:
	body = what
	name = "Held%s" % what.name
	monitoring = false
	monitorable = false
	collision_layer = 0
	collision_mask = what.collision_mask
	grip_point = at
	surface = SurfaceReader.find_own(what)
	var figures := MovableBody.new(what, 1, units).describe(null)
	mass = what.mass
	inertia = figures.get("inertia", 0.0)
	var center: PackedFloat64Array = figures.get("center", PackedFloat64Array([0.0, 0.0]))
	center_of_mass = Vector2(units.to_pixels(center[0]), -units.to_pixels(center[1]))


## Its shapes are the body's.
func get_shape_source() -> CollisionObject2D:
	return body


## False once the body left the scene.
func is_present() -> bool:
	return is_instance_valid(body) and body.is_inside_tree()


## The body is the loop's.
func freeze_body() -> void:
	_layer = body.collision_layer
	_mask = body.collision_mask
	_freeze = body.freeze
	_freeze_mode = body.freeze_mode
	_is_frozen = true
	body.freeze_mode = RigidBody2D.FREEZE_MODE_KINEMATIC
	body.freeze = true
	body.collision_layer = 0
	body.collision_mask = 0


## Brings the body to where the loop has it.
func carry() -> void:
	if _is_frozen and is_inside_tree() and is_present():
		body.global_transform = global_transform


## The body is Godot's again and goes on with this velocity (px/s of its center of mass, rad/s).
func give_back(velocity: Vector2, turning: float) -> void:
	if not _is_frozen:
		return
	_is_frozen = false
	if not is_instance_valid(body):
		return
	body.collision_layer = _layer
	body.collision_mask = _mask
	body.freeze = _freeze
	body.freeze_mode = _freeze_mode
	if body.is_inside_tree():
		# the server has a frozen body's transform a tick late
		PhysicsServer2D.body_set_state(
			body.get_rid(), PhysicsServer2D.BODY_STATE_TRANSFORM, body.global_transform
		)
		body.reset_physics_interpolation()
	if not _freeze:
		body.linear_velocity = velocity
		body.angular_velocity = turning
		body.sleeping = false
