extends GutTest
## Worlds beside one another, starting and stopping, and moved ones.

const Scene := preload("res://tests/support/haptic_scene.gd")


func before_each() -> void:
	Scene.hurry()


func after_each() -> void:
	Scene.calm_down()


func _push(world: HapticWorld2D, place: Transform2D) -> Node2D:
	var scene := Scene.gather(
		[world, Scene.make_tool(), Scene.make_wall(Vector2(0, 70), Vector2(480, 40))]
	)
	scene.transform = place
	return scene


func test_a_scene_without_a_haptic_world_runs_as_ever() -> void:
	var wall := Scene.make_wall(Vector2.ZERO, Vector2(400, 40))
	# falls 20 px onto it
	var object := Scene.make_object(Vector2(0, -60), Vector2(40, 40), 0.1)
	object.linear_velocity = Vector2(0, 100)
	var tool := Scene.make_tool(Vector2(0, -200))
	add_child_autofree(Scene.gather([wall, object, tool]))
	await wait_physics_frames(30)
	assert_almost_eq(object.position, Vector2(0, -40), Vector2(0.5, 0.5))
	assert_eq(tool.position, Vector2(0, -200))
	assert_null(tool.get_haptic_world())
	assert_eq(tool.get_contacts().size(), 0)
	assert_false(tool.is_touching(wall))
	assert_push_error("There is no HapticWorld2D in this scene")
	assert_push_error_count(1)


func test_two_viewports_hold_a_world_each() -> void:
	var worlds: Array[HapticWorld2D] = []
	for force: float in [1.0, 2.0]:
		var viewport := SubViewport.new()
		viewport.world_2d = World2D.new()
		add_child_autofree(viewport)
		worlds.append(Scene.make_world(Vector2(0, force)))
		viewport.add_child(_push(worlds[-1], Transform2D.IDENTITY))
	await wait_physics_frames(200)
	assert_almost_eq(worlds[0].get_force().y, -1.0, 0.01)
	assert_almost_eq(worlds[1].get_force().y, -2.0, 0.02)


func test_a_moved_and_turned_scene_feels_the_same() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	add_child_autofree(_push(world, Transform2D(0.6, Vector2(3000, -2000))))
	# the hand pushes along the device's own axes, so along the scene's
	await wait_physics_frames(200)
	var state := world.get_state()
	assert_almost_eq(state[HapticWorld2D.Gateway.State.FORCE_Y], 2.0, 0.02)
	assert_almost_eq(world.get_force(), Vector2(0, -2).rotated(0.6), Vector2(0.02, 0.02))
	assert_almost_eq(world.get_penetration(), 2.0 / 15000.0, 2e-6)


func test_a_world_stops_and_starts_again() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	watch_signals(world)
	add_child_autofree(_push(world, Transform2D.IDENTITY))
	await wait_physics_frames(10)
	world.stop()
	assert_false(world.is_running())
	assert_eq(world.get_force(), Vector2.ZERO)
	await wait_physics_frames(5)
	assert_true(world.start())
	await wait_physics_frames(190)
	assert_almost_eq(world.get_force().y, -2.0, 0.02)
	assert_signal_emit_count(world, "started", 2)
	assert_signal_emit_count(world, "stopped", 1)


func test_the_stop_key_takes_the_force_off_and_says_so() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	watch_signals(world)
	add_child_autofree(_push(world, Transform2D.IDENTITY))
	await wait_physics_frames(150)
	assert_gt(world.get_force().length(), 1.0)
	var key := InputEventKey.new()
	key.keycode = KEY_ESCAPE
	key.pressed = true
	Input.parse_input_event(key)
	# many ticks may share a frame on a busy machine, and input waits for the next one
	Input.flush_buffered_events()
	await wait_physics_frames(10)
	assert_false(world.is_armed())
	assert_almost_eq(world.get_force().length(), 0.0, 1e-9)
	assert_signal_emitted(world, "fault_raised")
	assert_string_contains(world.get_faults()[0], "Stop was pressed")


func test_a_real_time_world_runs_at_its_rate() -> void:
	Scene.calm_down()
	var world := Scene.make_world(Vector2(0, 2))
	world.mode = HapticWorld2D.Mode.REALTIME
	add_child_autofree(_push(world, Transform2D.IDENTITY))
	await wait_seconds(1.0)
	var figures := world.get_statistics()
	assert_eq(figures["mode"], "realtime")
	# a loaded machine may skip some
	assert_between(figures["steps"] as int, 300, 3000)
	assert_gt(figures["ve_ticks"] as int, 10)


func test_freeing_what_is_touched_and_the_tool_leaves_nothing_behind() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	var scene := _push(world, Transform2D.IDENTITY)
	add_child_autofree(scene)
	await wait_physics_frames(150)
	assert_eq(world.get_contacts().size(), 1)
	scene.get_node("Wall").queue_free()
	await wait_physics_frames(15)
	assert_eq(world.get_contacts().size(), 0)
	scene.get_node("Tool").queue_free()
	await wait_physics_frames(3)
	assert_false(world.is_running())
	assert_push_error("The tool is gone")


func test_a_surface_that_changes_is_felt() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	var scene := _push(world, Transform2D.IDENTITY)
	add_child_autofree(scene)
	await wait_physics_frames(150)
	(scene.get_node("Wall") as HapticWall2D).surface.stiffness = 7500.0
	await wait_physics_frames(60)
	assert_almost_eq(world.get_penetration(), 2.0 / 7500.0, 5e-6)


func test_the_plan_leaves_out_what_the_scene_does_not_need_and_says_why() -> void:
	var world := Scene.make_world(Vector2(0, 2))
	var scene := _push(world, Transform2D.IDENTITY)
	add_child_autofree(scene)
	await wait_physics_frames(5)
	var plan := world.get_plan()
	assert_has(plan, "contact detection: runs")
	assert_has(plan, "friction: left out, no pair of surfaces has friction")
	assert_has(plan, "gravity: left out, gravity is zero")
	assert_has(plan, "movable neighbors: left out, nothing near has a mass that can be pushed")
	# a rough wall comes near while it runs: the next snapshot brings the stage with it
	var wall: HapticWall2D = Scene.make_wall(Vector2(0, -90), Vector2(480, 40))
	wall.surface = HapticSurface.new()
	wall.surface.static_friction = 0.5
	wall.surface.dynamic_friction = 0.4
	scene.add_child(wall)
	await wait_physics_frames(5)
	assert_has(world.get_plan(), "friction: runs")
	assert_eq(world.get_statistics()["kernel"], "rigid tool, 3 freedoms, fixed size")
	world.stop()
	assert_eq(world.get_plan().size(), 0)
