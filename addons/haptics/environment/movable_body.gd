@tool
extends "body_reader.gd"
## RigidBody2D and HapticObject2D: Godot moves them, the tool pushes them and they push back.

# stands for a body that cannot turn, kg m²
const _NO_TURNING := 1.0e3
# concave outlines get no inertia but what the engine rounds: a radius of gyration below this, px
const _LEAST_RADIUS := 1.0e-3


func kind() -> String:
	var body := node as RigidBody2D
	if not body.freeze:
		return "movable"
	return "fixed" if body.freeze_mode == RigidBody2D.FREEZE_MODE_STATIC else "kinematic"


func describe(fallback: HapticSurface) -> Dictionary:
	var body := node as RigidBody2D
	var description := super.describe(fallback)
	if body.freeze:
		return description
	description["mass"] = body.mass
	description["inertia"] = _inertia(body)
	var center := body.center_of_mass
	var state := PhysicsServer2D.body_get_direct_state(body.get_rid())
	if body.center_of_mass_mode == RigidBody2D.CENTER_OF_MASS_MODE_AUTO and state != null:
		center = state.center_of_mass_local
	description["center"] = _units.local_to_meters(center)
	return description


func read_state(tick: int, seconds: float) -> PackedFloat64Array:
	var body := node as RigidBody2D
	if body.freeze:
		return super.read_state(tick, seconds)
	_rests = false
	_fall(body)
	var at := body.global_transform
	if body.sleeping and _seen_at == at and _seen_frame == _units.frame:
		_set_velocity(0.0, 0.0, 0.0)
	else:
		_place(at)
		var velocity := _units.velocity_to_meters(body.linear_velocity)
		_set_velocity(velocity[0], velocity[1], -body.angular_velocity)
	_tick = tick
	return _state


func take_impulse(x: float, y: float, angular: float, time_scale: float) -> void:
	var body := node as RigidBody2D
	if body.freeze:
		return
	body.sleeping = false
	body.apply_central_impulse(_units.impulse_to_canvas(x, y) / time_scale)
	if not body.lock_rotation:
		body.apply_torque_impulse(_units.angular_impulse_to_canvas(angular) / time_scale)


# gravity as the engine has it for this body (its areas, its scale), and its constant force
func _fall(body: RigidBody2D) -> void:
	var fall := body.constant_force / body.mass
	var state := PhysicsServer2D.body_get_direct_state(body.get_rid())
	if state != null and not body.custom_integrator:
		fall += state.total_gravity
	var acceleration := _units.velocity_to_meters(fall)
	_state[6] = acceleration[0]
	_state[7] = acceleration[1]


# rigid bodies lose their scale anyway; a warning says so
func scaling() -> Transform2D:
	return Transform2D.IDENTITY


func _features() -> Array:
	var body := node as RigidBody2D
	var features := super._features()
	features.append_array([body.mass, body.inertia, body.center_of_mass_mode, body.center_of_mass])
	features.append_array([body.freeze, body.freeze_mode, body.lock_rotation])
	return features


# 0 lets the native side compute it from the shapes
func _inertia(body: RigidBody2D) -> float:
	if body.lock_rotation:
		return _NO_TURNING
	if body.inertia > 0.0:
		return _units.inertia_to_meters(body.inertia)
	var state := PhysicsServer2D.body_get_direct_state(body.get_rid())
	if state == null or state.inverse_inertia * body.mass * _LEAST_RADIUS * _LEAST_RADIUS > 1.0:
		return 0.0
	if state.inverse_inertia <= 0.0:
		return 0.0
	return _units.inertia_to_meters(1.0 / state.inverse_inertia)
