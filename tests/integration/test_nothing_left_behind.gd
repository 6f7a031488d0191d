extends GutTest
## Scene change, reload, pause and stop, again and again while the loop runs: no thread and no force
## stays behind. Quitting and the editor's stop take the process along: tools/testing/quit_test.sh.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Threads := preload("res://tests/support/loop_threads.gd")

const CYCLES := 200
# of those that wait until the hand leans on the wall
const PUSHED := 3

var _native: HapticWorld2D.Gateway


func before_each() -> void:
	# frames wait for no display here: ticks follow one another closely
	Engine.physics_ticks_per_second = 480
	Engine.max_physics_steps_per_frame = 64


func after_each() -> void:
	Scene.calm_down()
	get_tree().paused = false


# a scene with a hand that leans on a wall, as a game would load it
func _pack(mode: HapticWorld2D.Mode) -> PackedScene:
	var world := Scene.make_world()
	# a spring holds it, so that it stays where it is when nothing pushes back
	(world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.15, 0.0, 0.0, 0.0], [0.3, 0.0, 0.005, 0.0]]
	)
	world.mode = mode
	world.safety = HapticSafetyLimits.new()
	world.safety.ramp_time = 0.05
	var scene := Scene.gather(
		[world, Scene.make_tool(), Scene.make_wall(Vector2(0, 70), Vector2(480, 40))]
	)
	_own(scene, scene)
	var packed := PackedScene.new()
	assert_eq(packed.pack(scene), OK)
	scene.free()
	return packed


func _own(node: Node, scene: Node) -> void:
	for child: Node in node.get_children():
		child.owner = scene
		_own(child, scene)


func _world() -> HapticWorld2D:
	return get_tree().current_scene.get_node("World") as HapticWorld2D


func _native_of(world: HapticWorld2D) -> HapticWorld2D.Gateway:
	return world._session.native


# waits until the present scene's loop runs, or until the hand leans on the wall
func _run(pushed: bool) -> void:
	var world := _world()
	if not world.is_running():
		await world.started
	_native = _native_of(world)
	while pushed and world.get_force().length() < 1.0:
		await wait_physics_frames(1)


func _leave_nothing(cycle: int) -> void:
	if _native.is_running():
		fail_test("cycle %d: the old scene's loop runs on" % cycle)
	elif _native.get_last_force() != PackedFloat64Array([0.0, 0.0, 0.0]):
		fail_test("cycle %d: the force stays at %s" % [cycle, _native.get_last_force()])


func _close_scene() -> void:
	get_tree().current_scene.free()
	assert_eq(Threads.count(), 0)


func test_changing_the_scene_while_the_loop_runs() -> void:
	var packed := _pack(HapticWorld2D.Mode.REALTIME)
	assert_eq(get_tree().change_scene_to_packed(packed), OK)
	await get_tree().scene_changed
	for cycle: int in CYCLES:
		await _run(cycle < PUSHED)
		assert_eq(get_tree().change_scene_to_packed(packed), OK)
		await get_tree().scene_changed
		_leave_nothing(cycle)
		if Threads.count() > 1:
			fail_test("cycle %d: %d loops run" % [cycle, Threads.count()])
	_close_scene()


func test_reloading_the_scene_while_the_loop_runs() -> void:
	var path := OS.get_user_data_dir().path_join("reload.tscn")
	assert_eq(ResourceSaver.save(_pack(HapticWorld2D.Mode.REALTIME), path), OK)
	assert_eq(get_tree().change_scene_to_file(path), OK)
	await get_tree().scene_changed
	for cycle: int in CYCLES:
		await _run(cycle < PUSHED)
		assert_eq(get_tree().reload_current_scene(), OK)
		await get_tree().scene_changed
		_leave_nothing(cycle)
		if Threads.count() > 1:
			fail_test("cycle %d: %d loops run" % [cycle, Threads.count()])
	_close_scene()
	DirAccess.remove_absolute(path)


func test_stopping_and_starting_while_the_loop_runs() -> void:
	assert_eq(get_tree().change_scene_to_packed(_pack(HapticWorld2D.Mode.REALTIME)), OK)
	await get_tree().scene_changed
	for cycle: int in CYCLES:
		await _run(cycle < PUSHED)
		_world().stop()
		_leave_nothing(cycle)
		if Threads.count() > 0:
			fail_test("cycle %d: %d loops run" % [cycle, Threads.count()])
		assert_true(_world().start())
	_close_scene()


func test_pausing_while_a_hand_leans() -> void:
	Scene.hurry()
	# in lock-step the loop goes on with the ticks that a paused tree does not get: an outer node that
	# is never paused drives the world
	assert_eq(get_tree().change_scene_to_packed(_pack(HapticWorld2D.Mode.LOCKSTEP)), OK)
	await get_tree().scene_changed
	await _run(true)
	await wait_physics_frames(60)
	var full := _world().get_force().length()
	assert_gt(full, 1.5)
	for cycle: int in CYCLES:
		get_tree().paused = true
		_native.advance(0.06)
		_native.refresh()
		var force := _native.get_state()[HapticWorld2D.Gateway.State.FORCE_Y]
		if force != 0.0:
			fail_test("cycle %d: paused, and still %s N" % [cycle, force])
		get_tree().paused = false
		_native.advance(0.06)
		_native.refresh()
	assert_eq(_world().get_faults(), PackedStringArray())
	await wait_physics_frames(60)
	assert_almost_eq(_world().get_force().length(), full, 0.02)
	_close_scene()
