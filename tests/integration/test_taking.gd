extends GutTest
## Taking things into the hand while the scene runs: bodies, links, tools, and what may go wrong.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")

var _world: HapticWorld2D
var _linkage: HapticLinkage2D
var _tool: HapticTool2D
var _object: HapticObject2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func before_each() -> void:
	_world = Scene.make_world()
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	_tool = Scene.make_tool(Vector2(0, 300), Vector2(60, 60))
	_object = Scene.make_object(Vector2(-200, 0), Vector2(60, 60), 0.2)


func _run(ticks: int, more: Array[Node] = []) -> void:
	var nodes: Array[Node] = [_world, _linkage, _tool, _object]
	add_child_autofree(Scene.gather(nodes + more))
	await wait_physics_frames(ticks)


func _move_hand(rows: Array[PackedFloat64Array]) -> void:
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(rows)


func test_a_held_body_is_the_loops_and_comes_back_with_its_velocity() -> void:
	# to the right, and turning
	var path: Array[PackedFloat64Array] = [
		[0.0, 0.0, 0.0, 0.0], [0.4, 0.0, 0.0, 0.0], [2.4, 0.1, 0.0, 1.0]
	]
	_move_hand(path)
	_object.collision_layer = 5
	_object.collision_mask = 3
	# nothing in its way
	_object.position = Vector2(-200, -300)
	await _run(5)
	assert_true(_world.take(_object))
	await wait_physics_frames(60)
	assert_same(_world.get_held_body(), _object)
	assert_true(_object.freeze)
	assert_eq(_object.collision_layer, 0)
	assert_eq(_object.collision_mask, 0)
	assert_almost_eq(_object.global_position, _world.get_grip().origin, Vector2(0.05, 0.05))
	assert_gt(_object.global_position.x, -200.0 + 60.0)
	# how fast it is, by where it was
	var before := _object.global_transform
	var ticks := Engine.get_physics_frames()
	await wait_physics_frames(2)
	var seconds := (Engine.get_physics_frames() - ticks) / 60.0
	var speed := (_object.global_position - before.origin) / seconds
	var turning := (_object.global_rotation - before.get_rotation()) / seconds
	assert_gt(speed.x, 150.0)
	assert_gt(turning, 0.3)
	assert_true(_world.take(_tool))
	assert_null(_world.get_held_body())
	assert_false(_object.freeze)
	assert_eq(_object.collision_layer, 5)
	assert_eq(_object.collision_mask, 3)
	var at := _object.global_position
	var from := Engine.get_physics_frames()
	await wait_physics_frames(30)
	assert_almost_eq(_object.linear_velocity, speed, 0.05 * Vector2(speed.x, speed.x))
	assert_almost_eq(_object.angular_velocity, turning, 0.05 * turning)
	var passed := (Engine.get_physics_frames() - from) / 60.0
	assert_almost_eq(
		_object.global_position - at, speed * passed, 0.06 * passed * Vector2(speed.x, speed.x)
	)


func test_a_moving_body_that_is_taken_comes_to_rest_in_the_hand() -> void:
	await _run(5)
	_object.linear_velocity = Vector2(400, 0)
	await wait_physics_frames(3)
	var at := _object.global_position
	assert_true(_world.take(_object))
	await wait_physics_frames(90)
	assert_lt(_world.get_speed(), 0.001)
	# on its way while the hand closes: 0.1 s of 400 px/s at most, and back towards where it was taken
	assert_between(_object.global_position.x - at.x, -4.0, 40.0)


func test_a_held_body_is_stopped_by_walls_and_felt() -> void:
	_world.free()
	_world = Scene.make_world(Vector2(2.0, 0.0), 0.5)
	var more: Array[Node] = [Scene.make_wall(Vector2(-100, 0), Vector2(40, 400))]
	await _run(2, more)
	assert_true(_world.take(_object, Vector2(0, 0)))
	await wait_physics_frames(180)
	# as deep as the two surfaces give way in series
	var depth := 2.0 / 7500.0 * 4000.0
	assert_almost_eq(_object.global_position.x, -150.0 + depth, 0.05)
	assert_almost_eq(_world.get_force().x, -2.0, 0.05)
	assert_true(_world.get_tool().is_touching(more[0] as Node2D))


func test_what_lies_at_a_point_is_taken_there() -> void:
	await _run(3)
	assert_true(_world.take_at(Vector2(-210, 5)))
	assert_same(_world.get_held_body(), _object)
	await wait_physics_frames(20)
	assert_almost_eq(_world.get_grip().origin, Vector2(-210, 5), Vector2(0.5, 0.5))
	var second := _linkage.get_links()[1]
	var point := second.to_global(Vector2(30, 2))
	assert_true(_world.take_at(point))
	assert_same(_world.get_tool(), second)
	await wait_physics_frames(20)
	assert_almost_eq(_world.get_grip().origin, second.to_global(Vector2(30, 2)), Vector2(0.1, 0.1))
	assert_false(_world.take_at(Vector2(3000, 3000)))
	assert_same(_world.get_tool(), second)


func test_a_hundred_switches() -> void:
	await _run(5)
	var things: Array[CollisionObject2D] = [_tool, _object]
	things.append_array(_linkage.get_links())
	var children := _world.get_child_count(true)
	for i: int in 100:
		var what := things[(i * 7 + i % 3) % things.size()]
		assert_true(_world.take(what))
		await wait_physics_frames(1 + i % 3)
	assert_true(_world.take(_tool))
	await wait_physics_frames(40)
	assert_true(_world.is_armed())
	assert_eq(_world.get_faults(), PackedStringArray())
	assert_eq(_world.get_child_count(true), children)
	assert_false(_object.freeze)
	assert_eq(_object.collision_layer, 1)
	assert_almost_eq(_world.get_force(), Vector2.ZERO, Vector2(1e-3, 1e-3))


func test_a_held_link_that_is_freed() -> void:
	await _run(5)
	assert_true(_world.take(_linkage.get_links()[1]))
	await wait_physics_frames(20)
	_linkage.get_links()[1].free()
	await wait_physics_frames(3)
	assert_false(_world.is_running())
	assert_push_error("Linkage got, lost or moved a link while it was held")
	assert_true(_world.take(_linkage.get_links()[0]))
	await wait_physics_frames(20)
	assert_true(_world.is_armed())


func test_a_link_that_is_given_to_another_parent_while_held() -> void:
	var other := Node2D.new()
	await _run(5, [other] as Array[Node])
	var third := _linkage.get_links()[2]
	assert_true(_world.take(third))
	await wait_physics_frames(20)
	third.reparent(other)
	await wait_physics_frames(3)
	assert_false(_world.is_running())
	assert_push_error("Linkage got, lost or moved a link while it was held")
	assert_false(_world.take(third))
	assert_push_error("is a link without a HapticLinkage2D")
	third.reparent(_linkage.get_links()[1])
	assert_true(_world.take(third))
	await wait_physics_frames(20)
	assert_true(_world.is_armed())


func test_a_linkage_that_is_freed_while_held() -> void:
	await _run(5)
	assert_true(_world.take(_linkage.get_links()[0]))
	await wait_physics_frames(20)
	_linkage.free()
	await wait_physics_frames(3)
	assert_false(_world.is_running())
	assert_push_error("The tool is gone")
	assert_true(_world.start())
	assert_same(_world.get_tool(), _tool)


func test_a_body_that_is_freed_or_leaves_while_held() -> void:
	await _run(5)
	assert_true(_world.take(_object))
	await wait_physics_frames(20)
	var parent := _object.get_parent()
	parent.remove_child(_object)
	await wait_physics_frames(3)
	assert_false(_world.is_running())
	assert_push_error("The tool is gone")
	assert_false(_object.freeze)
	assert_eq(_object.collision_layer, 1)
	parent.add_child(_object)
	assert_true(_world.take(_object))
	await wait_physics_frames(5)
	_object.free()
	await wait_physics_frames(3)
	assert_false(_world.is_running())


func test_a_free_linkage_that_changes_goes_on() -> void:
	await _run(5)
	assert_not_null(_linkage.get_mover())
	_linkage.get_links()[2].free()
	await wait_physics_frames(3)
	assert_not_null(_linkage.get_mover())
	var more := Linkages.make_link("More", Vector2(50, 20))
	_linkage.get_links()[1].add_child(more)
	await wait_physics_frames(3)
	assert_not_null(_linkage.get_mover())
	_linkage.free()
	await wait_physics_frames(3)
	assert_true(_world.is_running())


func test_what_cannot_be_held() -> void:
	await _run(5)
	assert_false(_world.take(null))
	assert_push_error("take() needs a tool, a link or a RigidBody2D")
	assert_false(_world.take(_object, Vector2(NAN, 0)))
	assert_push_error("the point is")
	assert_false(_linkage.grab(null, Vector2.ZERO))
	assert_push_error("grab() needs one of its own links")
	assert_true(_world.is_running())
	assert_same(_world.get_tool(), _tool)
	_object.get_node("Shape").free()
	assert_false(_world.take(_object))
	assert_push_error("cannot be held")
	assert_false(_object.freeze)
	assert_true(_world.take(_tool))


func test_a_link_that_is_broken_while_the_scene_runs() -> void:
	await _run(5)
	_linkage.get_links()[1].mass = NAN
	assert_false(_world.take(_linkage.get_links()[2]))
	assert_push_error("Link2.mass is nan")
	# it moves no more, and says so once
	await wait_physics_frames(70)
	assert_null(_linkage.get_mover())
	_linkage.get_links()[1].mass = 0.1
	await wait_physics_frames(70)
	assert_not_null(_linkage.get_mover())
	assert_true(_world.take(_linkage.get_links()[2]))
	await wait_physics_frames(20)
	assert_true(_world.is_armed())
