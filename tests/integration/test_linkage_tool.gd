extends GutTest
## A linkage is the tool: held by any link, felt wherever any link touches, grabbed elsewhere.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")

var _world: HapticWorld2D
var _linkage: HapticLinkage2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _links() -> Array[HapticLink2D]:
	return _linkage.get_links()


# the ends of a chain stay on each other
func _assert_joined() -> void:
	for link: HapticLink2D in _links():
		var above := link.get_parent_link()
		var at := _linkage.global_position
		if above != null:
			at = above.to_global(Vector2(100.0, 0.0))
		assert_almost_eq(link.global_position, at, Vector2(0.01, 0.01), "joint of %s" % link.name)


func _run(world: HapticWorld2D, more: Array[Node], ticks: int) -> void:
	_world = world
	var nodes: Array[Node] = [_world, _linkage]
	add_child_autofree(Scene.gather(nodes + more))
	await wait_physics_frames(ticks)


func test_a_door_gives_way_about_its_hinge_and_pushes_back_at_its_stop() -> void:
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	var wall := Scene.make_wall(Vector2(160, 60), Vector2(40, 40))
	var more: Array[Node] = [wall]
	await _run(Scene.make_world(Vector2(0, 1.5)), more, 180)
	assert_eq(_world.get_faults(), PackedStringArray())
	var door := _links()[0]
	assert_almost_eq(door.global_position, Vector2.ZERO, Vector2(0.01, 0.01))
	# until its lower edge rests on the corner of the wall
	assert_between(door.rotation, 0.15, 0.22)
	assert_almost_eq(_links()[0].get_coordinate(), door.rotation, 1e-6)
	# the moments about the hinge balance: wall at 0.035 m or so, hand at 0.05 m
	assert_almost_eq(_world.get_force().y, -1.5, 0.15)
	assert_true(door.is_touching(wall))
	var lever := door.get_contacts()[0].position.length() / _world.pixels_per_meter
	var push := door.get_force_from(wall).length() * lever
	assert_almost_eq(push, 1.5 * 0.05 * cos(door.rotation), 0.1 * push)


func test_a_hand_feels_nothing_of_a_door_that_rests() -> void:
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	await _run(Scene.make_world(), [], 60)
	assert_almost_eq(_world.get_force(), Vector2.ZERO, Vector2(1e-3, 1e-3))
	assert_almost_eq(_links()[0].rotation, 0.0, 1e-3)


func test_an_arm_is_held_by_any_of_its_links() -> void:
	for held: int in 3:
		_linkage = Linkages.make_chain(3, Vector2(100, 20))
		_linkage.start_link = _links()[held]
		var before := _links()[held].to_global(Vector2(100.0, 0.0))
		var path: Array[PackedFloat64Array] = [
			[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [1.2, -0.002, 0.004, 0.0]
		]
		var world := Scene.make_world()
		(world.device as HapticSimulatedPantograph).hand = Scene.make_path(path)
		await _run(world, [], 100)
		assert_eq(_world.get_faults(), PackedStringArray())
		assert_same(_linkage.get_held_link(), _links()[held])
		_assert_joined()
		var moved := _links()[held].to_global(Vector2(100.0, 0.0)) - before
		assert_gt(moved.y, 8.0, "held by link %d" % held)
		assert_almost_eq(_world.get_grip().origin, before + moved, Vector2(0.01, 0.01))
		_world.get_parent().queue_free()
		await wait_physics_frames(2)


func test_grabbing_another_link_starts_without_force() -> void:
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	var path: Array[PackedFloat64Array] = [
		[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [1.0, -0.002, 0.004, 0.0]
	]
	var world := Scene.make_world()
	(world.device as HapticSimulatedPantograph).hand = Scene.make_path(path)
	await _run(world, [], 90)
	watch_signals(_world)
	var second := _links()[1]
	assert_true(_linkage.grab(second, Vector2(40, 0)))
	var most := 0.0
	for i: int in 30:
		await wait_physics_frames(1)
		most = maxf(most, _world.get_force().length())
	assert_same(_linkage.get_held_link(), second)
	assert_signal_emitted_with_parameters(_world, "tool_changed", [_links()[2], second])
	assert_almost_eq(
		_world.get_grip().origin, second.to_global(Vector2(40, 0)), Vector2(0.01, 0.01)
	)
	assert_lt(most, 0.05)
	assert_true(_world.is_held())


func test_every_link_is_stopped_and_looked_around() -> void:
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	# below the first link, far from the hand
	var wall := Scene.make_wall(Vector2(50, 40), Vector2(40, 40))
	var more: Array[Node] = [wall]
	_linkage.start_link = _links()[0]
	await _run(Scene.make_world(Vector2(0, 1.0)), more, 150)
	assert_eq(_world.get_reach().size(), 3)
	assert_true(_links()[0].is_touching(wall))
	assert_lt(_world.get_penetration(), 0.0005)


func test_tools_are_switched_at_run_time() -> void:
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	var tool := Scene.make_tool(Vector2(0, 300), Vector2(60, 60))
	var more: Array[Node] = [tool]
	await _run(Scene.make_world(), more, 20)
	assert_same(_world.get_tool(), tool)
	watch_signals(_world)
	assert_true(_linkage.grab(_links()[1], Vector2(50, 0)))
	await wait_physics_frames(30)
	assert_same(_world.get_tool(), _links()[1])
	assert_true(_world.is_armed())
	assert_signal_emitted_with_parameters(_world, "tool_changed", [tool, _links()[1]])
	assert_true(_world.take(tool))
	await wait_physics_frames(30)
	assert_same(_world.get_tool(), tool)
	assert_true(_world.is_armed())
	assert_almost_eq(_world.get_force(), Vector2.ZERO, Vector2(1e-3, 1e-3))
