extends GutTest
## Linkages beside a tool on the loop's own thread: they meet, and come and go while it runs.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")

var _world: HapticWorld2D
var _linkage: HapticLinkage2D


func before_each() -> void:
	_world = Scene.make_world(Vector2(0.0, 1.5), 0.3)
	_world.mode = HapticWorld2D.Mode.REALTIME
	_linkage = Linkages.make_chain(1, Vector2(200, 20))


func test_a_push_on_a_door_at_its_stop_comes_back() -> void:
	var door := _linkage.get_links()[0]
	door.has_limits = true
	door.lower_limit = -0.1
	door.upper_limit = 0.1
	var tool := Scene.make_tool(Vector2(150, -22), Vector2(40, 20))
	# or it slides off
	tool.surface = Linkages.make_rough()
	door.surface = Linkages.make_rough()
	add_child_autofree(Scene.gather([_world, _linkage, tool] as Array[Node]))
	var waited := 0
	while not tool.is_touching(door) and waited < 600:
		waited += 1
		await wait_physics_frames(1)
	await wait_physics_frames(90)
	assert_true(tool.is_touching(door))
	assert_false(_linkage.is_tool())
	assert_almost_eq(door.get_coordinate(), 0.1, 0.005)
	assert_almost_eq(tool.get_force_from(door).length(), 1.5, 0.1)
	assert_eq(_world.get_faults(), PackedStringArray())


func test_linkages_come_and_go_while_the_loop_runs() -> void:
	_world.free()
	_world = Scene.make_world()
	_world.mode = HapticWorld2D.Mode.REALTIME
	var tool := Linkages.make_ball(Vector2(0, 500), 20.0)
	var scene := Scene.gather([_world, _linkage, tool] as Array[Node])
	add_child_autofree(scene)
	await wait_physics_frames(5)
	for i: int in 30:
		var other := Linkages.make_chain(1 + i % 3, Vector2(60, 20), Vector2(40 * i, 120))
		scene.add_child(other)
		await wait_physics_frames(2)
		assert_not_null(other.get_mover())
		if i % 2 == 0:
			other.free()
		elif i % 4 == 1:
			other.queue_free()
	# of the eight places none is lost, and what has none moves all the same
	await wait_physics_frames(3)
	for node: Node in scene.get_children():
		var linkage := node as HapticLinkage2D
		if linkage != null:
			assert_not_null(linkage.get_mover())
	assert_true(_world.is_running())
	for i: int in 20:
		assert_true(_world.take(tool if i % 2 == 0 else _linkage.get_links()[0]))
		await wait_physics_frames(1 + i % 3)
	assert_true(_world.is_running())
	assert_eq(_world.get_faults(), PackedStringArray())
