extends GutTest
## The main thread is late, and the hand does not notice: it leans on a wall, slides along a body
## that a script moves and on one that glides, on the real loop, while frames take 50 ms to 3 s.
##
## HAPTICS_LATE_FRAMES=1 adds the two bodies in motion: beside a busy processor their own frames are
## late in ways that no test can foresee, so that the suites have the wall alone.
##
## Nothing here asks how fast the machine is: the loop's own record is looked at, step by step, and
## what it does undisturbed is the measure. native/tests/core/local_model/frame_spike_test.cpp does
## the same without a clock, in many more cases.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Rows := preload("res://tests/support/run_rows.gd")
const _TIME := HapticWorld2D.Gateway.State.TIME

# of what moves, px/s
const _SPEED := 200.0
# when the hand has settled, s
const _SETTLED := 1.6

var _worlds: Array[HapticWorld2D] = []


func after_each() -> void:
	_worlds.clear()


# a hand that leans with about 3 N, 6 mm deep
func _add_world(body: Node2D) -> void:
	var world := Scene.make_world()
	world.mode = HapticWorld2D.Mode.REALTIME
	world.record_seconds = 30.0
	(world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [1.1, 0.0, 0.006, 0.0]]
	)
	var viewport := SubViewport.new()
	viewport.world_2d = World2D.new()
	add_child_autofree(viewport)
	viewport.add_child(Scene.gather([world, Scene.make_tool(), body]))
	_worlds.append(world)


func _start() -> void:
	_add_world(Scene.make_wall(Vector2(0, 70), Vector2(480, 40)))
	if OS.has_environment("HAPTICS_LATE_FRAMES"):
		_add_bodies_in_motion()
	for world: HapticWorld2D in _worlds:
		while _loop_time(world) < _SETTLED + 0.3:
			await wait_physics_frames(1)
		assert_true(world.is_armed())
		assert_eq(world.get_contacts().size(), 1)


func _add_bodies_in_motion() -> void:
	var rough := HapticSurface.new()
	rough.static_friction = 0.3
	rough.dynamic_friction = 0.3
	var moved := Mover.new()
	moved.position = Vector2(0, 70)
	moved.add_child(Scene.make_box(Vector2(6000, 40)))
	moved.set_meta(&"haptic_surface", rough)
	_add_world(moved)
	# heavy, and on a floor, so that it does not give way
	var gliding := Scene.make_object(Vector2.ZERO, Vector2(4000, 40), 5.0)
	gliding.linear_velocity.x = _SPEED
	gliding.lock_rotation = true
	var ground := StaticBody2D.new()
	ground.position = Vector2(0, 40)
	ground.add_child(Scene.make_box(Vector2(12000, 40)))
	ground.physics_material_override = PhysicsMaterial.new()
	ground.physics_material_override.friction = 0.0
	var below := Scene.gather([gliding, ground])
	below.position = Vector2(0, 70)
	_add_world(below)


func _loop_time(world: HapticWorld2D) -> float:
	return world.get_state()[_TIME] if world.is_running() else 0.0


# begin and end of what `late` does to the main thread, for each world on its loop's clock
func _while(late: Callable) -> Array[Vector2]:
	var spans: Array[Vector2] = []
	for world: HapticWorld2D in _worlds:
		spans.append(Vector2(_loop_time(world) - 0.02, 0.0))
	await late.call()
	await wait_seconds(0.4)
	for i: int in _worlds.size():
		spans[i].y = _loop_time(_worlds[i])
	return spans


func _block(milliseconds: int) -> void:
	OS.delay_msec(milliseconds)
	await wait_process_frames(1)


# frames of 50 ms, three ticks in each
func _draw_slowly() -> void:
	for i: int in 12:
		OS.delay_msec(50)
		await wait_process_frames(1)


# what was recorded from the first of the spans on beside what was before; to read it takes the main
# thread a while, so that this comes last
func _check(all: Array[Array]) -> void:
	for i: int in _worlds.size():
		var rows: Rows = Rows.of(_worlds[i])
		var first: Vector2 = all[0][i]
		var usual := rows.worst_jump(_SETTLED, first.x)
		var least := rows.smallest_force(_SETTLED, first.x)
		var most := rows.largest_force(_SETTLED, first.x)
		for turn: int in all.size():
			var title := "disturbance %d, world %d" % [turn, i]
			var span: Vector2 = all[turn][i]
			var seen := rows.worst_jump(span.x, span.y)
			assert_gt(rows.count(span.x, span.y), 200, title)
			assert_lt(seen.x, 1.0 + usual.x, "%s, at %s s" % [title, seen.y])
			assert_lt(rows.largest_force(span.x, span.y), 1.2 * most, title)
			assert_gt(rows.smallest_force(span.x, span.y), 0.8 * least, title)
		assert_eq(_worlds[i].get_faults(), PackedStringArray())


func test_late_frames_are_not_felt() -> void:
	await _start()
	var all: Array[Array] = []
	for late: Callable in [_block.bind(50), _block.bind(500), _draw_slowly]:
		all.append(await _while(late))
	_check(all)


func test_three_seconds_release_the_hand_softly_and_take_it_again() -> void:
	await _start()
	var spans := await _while(_block.bind(3000))
	for i: int in _worlds.size():
		var rows: Rows = Rows.of(_worlds[i])
		var title := "world %d" % i
		var most := rows.largest_force(_SETTLED, spans[i].x)
		# gone within 1.1 s, and back within half a second
		assert_eq(rows.largest_force(spans[i].x + 1.3, spans[i].x + 2.8), 0.0, title)
		assert_gt(rows.smallest_force(spans[i].y - 0.1, spans[i].y), 0.7 * most, title)
		assert_lt(rows.largest_force(spans[i].x, spans[i].y), 2.0 * most, title)
		# in 50 ms, not at once
		assert_lt(rows.largest_change(spans[i].x, spans[i].y), 0.1 * most, title)
		assert_eq(_worlds[i].get_faults(), PackedStringArray())


class Mover:
	extends AnimatableBody2D
	## Moves evenly.

	func _init() -> void:
		sync_to_physics = false

	func _physics_process(delta: float) -> void:
		position.x += _SPEED * delta
