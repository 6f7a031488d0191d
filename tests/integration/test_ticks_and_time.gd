extends GutTest
## The rate of physics ticks, interpolation, the scale of time, pause and several viewports: what is
## felt is what the scene is.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Rows := preload("res://tests/support/run_rows.gd")
const _TIME := HapticWorld2D.Gateway.State.TIME
const _TOOL_Y := HapticWorld2D.Gateway.State.TOOL_Y

# scene seconds in a second, in lock-step
const _HURRY := 16
const _TICKS: Array[int] = [60, 20, 30, 120, 240]
const _SCALES: Array[float] = [0.1, 4.0]
# a wall that rises, m/s of real time
const _RISE := 0.004


func after_each() -> void:
	Scene.calm_down()
	get_tree().physics_interpolation = false
	get_tree().paused = false


# a hand on a spring that leans on what lies below from 1.1 s on, 6 mm deep
func _lean() -> HapticSimulatedHand:
	return Scene.make_path([[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [1.1, 0.0, 0.006, 0.0]])


func _add_scene(world: HapticWorld2D, more: Node2D) -> void:
	var viewport := SubViewport.new()
	viewport.world_2d = World2D.new()
	viewport.physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_ON
	add_child_autofree(viewport)
	viewport.add_child(Scene.gather([world, Scene.make_tool(), more]))


func _wait_until(world: HapticWorld2D, time: float) -> void:
	while world.get_state().is_empty() or world.get_state()[_TIME] < time:
		await wait_physics_frames(1)


# the mean force (N) once it is steady and the worst jump between two steps, over what may be
func _push(ticks: int, wall: Node2D) -> Vector2:
	_set_ticks(ticks)
	# the ticks that are left of this frame still have the length that was set before
	await wait_process_frames(2)
	var world := Scene.make_world()
	world.record_seconds = 4.0
	(world.device as HapticSimulatedPantograph).hand = _lean()
	_add_scene(world, wall)
	await _wait_until(world, 2.5)
	var rows: Rows = Rows.of(world)
	assert_eq(world.get_faults(), PackedStringArray())
	assert_eq(rows.count(1.45, 2.45), 1000)
	var result := Vector2(rows.mean_force(1.45, 2.45), rows.worst_jump(1.45, 2.45).x)
	wall.get_parent().queue_free()
	await wait_physics_frames(2)
	return result


func _make_floor() -> Node2D:
	return Scene.make_wall(Vector2(0, 70), Vector2(480, 40))


func _make_mover() -> Node2D:
	var wall := Mover.new()
	wall.position = Vector2(0, 70)
	wall.add_child(Scene.make_box(Vector2(4000, 40)))
	return wall


# pushes on what `make` makes, at every rate of ticks, and with interpolation
func _push_at_every_rate(make: Callable) -> void:
	var usual := 0.0
	# the last ones with interpolation
	for i: int in _TICKS.size() + 2:
		var ticks := _TICKS[i % _TICKS.size()]
		get_tree().physics_interpolation = i >= _TICKS.size()
		var felt: Vector2 = await _push(ticks, make.call() as Node2D)
		usual = felt.x if usual == 0.0 else usual
		var where := "%d ticks a second" % ticks
		assert_between(felt.x, 2.5, 4.0, where)
		assert_almost_eq(felt.x, usual, 0.01 * usual, where)
		assert_lt(felt.y, 1.0, "jump at %s" % where)


func test_a_push_on_a_wall_is_the_same_at_every_rate_of_ticks() -> void:
	await _push_at_every_rate(_make_floor)


func test_a_wall_in_motion_does_not_jump_at_any_rate_of_ticks() -> void:
	await _push_at_every_rate(_make_mover)


func test_ticks_that_change_their_length_are_not_felt(
	rates: Array = use_parameters([[60, 240], [20, 240], [240, 20], [120, 30]])
) -> void:
	_set_ticks(rates[0] as int)
	await wait_process_frames(2)
	var world := Scene.make_world()
	world.record_seconds = 4.0
	(world.device as HapticSimulatedPantograph).hand = _lean()
	_add_scene(world, _make_mover())
	await _wait_until(world, 1.6)
	_set_ticks(rates[1] as int)
	await _wait_until(world, 2.5)
	var rows: Rows = Rows.of(world)
	assert_between(rows.mean_force(1.45, 2.45), 2.0, 4.0)
	assert_lt(rows.worst_jump(1.45, 2.45).x, 0.4)
	assert_eq(world.get_faults(), PackedStringArray())


func _set_ticks(ticks: int) -> void:
	Engine.physics_ticks_per_second = ticks * _HURRY
	Engine.max_physics_steps_per_frame = 64
	Engine.time_scale = _HURRY


func test_the_scale_of_time_scales_what_moves_and_not_the_hand() -> void:
	for scale: float in _SCALES:
		Engine.time_scale = scale
		var leaning := _make_realtime(_lean())
		_add_scene(leaning, Scene.make_wall(Vector2(0, 70), Vector2(480, 40)))
		var carried := _make_realtime(_lean())
		var wall := Mover.new()
		wall.position = Vector2(0, 70)
		wall.swing = 0.0
		wall.speed = Vector2(0.0, -_RISE * 4000.0 / scale)
		wall.add_child(Scene.make_box(Vector2(4000, 40)))
		_add_scene(carried, wall)
		var pushing := _make_realtime(
			Scene.make_path([[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [1.6, 0.0, 0.05, 0.0]])
		)
		(pushing.device as HapticSimulatedPantograph).hand.smooth = false
		var object := Scene.make_object(Vector2(0, 90), Vector2(160, 40), 0.1)
		_add_scene(pushing, object)
		await _wait_until(carried, 1.4)
		var before := carried.get_state()
		await wait_physics_frames(12)
		var after := carried.get_state()
		var speed := (after[_TOOL_Y] - before[_TOOL_Y]) / (after[_TIME] - before[_TIME])
		assert_almost_eq(speed, _RISE, 0.1 * _RISE, "the wall's speed at scale %s" % scale)
		# 50 mm/s of real time
		var pushed := object.linear_velocity.y / 4000.0 * scale
		assert_between(pushed, 0.035, 0.065, "the object's speed at scale %s" % scale)
		await _wait_until(leaning, 1.6)
		assert_almost_eq(leaning.get_force().length(), 2.79, 0.03, "force at scale %s" % scale)
		for world: HapticWorld2D in [leaning, carried, pushing]:
			assert_eq(world.get_faults(), PackedStringArray())
			world.get_parent().get_parent().queue_free()
		await wait_physics_frames(2)


func test_nearly_no_time_is_a_pause_and_comes_back_softly() -> void:
	var world := _make_realtime(_lean())
	world.record_seconds = 6.0
	_add_scene(world, Scene.make_wall(Vector2(0, 70), Vector2(480, 40)))
	await _wait_until(world, 1.5)
	var full := world.get_force().length()
	assert_gt(full, 2.0)
	for stop: Callable in [_stand_still, _pause]:
		stop.call(true)
		await _wait_real(0.3)
		# a paused tree shows no reports
		world.get_run().show()
		assert_eq(world.get_force(), Vector2.ZERO)
		stop.call(false)
		await _wait_real(0.6)
		assert_almost_eq(world.get_force().length(), full, 0.03 * full)
	assert_eq(world.get_faults(), PackedStringArray())
	var rows: Rows = Rows.of(world)
	# the hand has pushed the handle on meanwhile
	assert_lt(rows.largest_force(1.5, 10.0), 2.0 * full)


func _stand_still(still: bool) -> void:
	Engine.time_scale = 0.05 if still else 1.0


func _pause(paused: bool) -> void:
	get_tree().paused = paused


# a tree that is paused has no ticks for a test that waits for them
func _wait_real(seconds: float) -> void:
	await get_tree().create_timer(seconds, true, false, true).timeout


func _make_realtime(hand: HapticSimulatedHand) -> HapticWorld2D:
	var world := Scene.make_world()
	world.mode = HapticWorld2D.Mode.REALTIME
	(world.device as HapticSimulatedPantograph).hand = hand
	return world


class Mover:
	extends AnimatableBody2D
	## Slides evenly and swings up and down.

	## px/s.
	var speed := Vector2(200.0, 0.0)
	## px, at 1 Hz.
	var swing := 4.0

	var _time := 0.0
	var _start := Vector2.INF

	func _init() -> void:
		sync_to_physics = false

	func _physics_process(delta: float) -> void:
		if not _start.is_finite():
			_start = position
		_time += delta
		position = _start + speed * _time + Vector2(0.0, swing * sin(TAU * _time))
