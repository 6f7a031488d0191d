extends GutTest
## What goes wrong while a scene runs: it is said, and nothing that moves is lost by it.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# a box that is pressed down
func _run(more: Array[Node]) -> void:
	_world = Scene.make_world(Vector2(0.0, 2.0), 0.1)
	_tool = Scene.make_tool()
	var nodes: Array[Node] = [_world, _tool]
	add_child_autofree(Scene.gather(nodes + more))
	await wait_physics_frames(90)


# a figure that is wrong for a while: that is told, once and nothing else
func _break(of: Object, property: StringName, wrong: float, sound: float, told: String) -> void:
	of.set(property, wrong)
	await wait_physics_frames(3)
	of.set(property, sound)
	await wait_physics_frames(60)
	assert_push_error(told)
	assert_push_error_count(1)


func test_a_world_that_is_put_nowhere_moves_nothing_there() -> void:
	var object := Scene.make_object(Vector2(0, 70), Vector2(160, 40), 0.1)
	await _run([object, Scene.make_wall(Vector2(0, 120), Vector2(800, 40))])
	assert_almost_eq(_world.get_contact_force().y, -2.0, 0.1, "presses the object on the wall")
	await _break(_world, &"rotation", NAN, 0.0, "World: It stands at")
	assert_true(_tool.global_transform.is_finite())
	assert_true(object.global_transform.is_finite(), str(object.global_transform))
	assert_almost_eq(_world.get_contact_force().y, -2.0, 0.1, "as before")


func test_a_surface_that_breaks_while_it_is_touched_is_told_by_its_wall() -> void:
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(800, 40))
	await _run([wall])
	assert_lt(_world.get_contact_force().y, -1.9)
	var told := "Wall: surface.stiffness is nan N/m"
	await _break(wall.surface, &"stiffness", NAN, 15000.0, told)


func test_a_start_that_fails_later_on_says_why() -> void:
	await _run([])
	_world.stop()
	_world.device = null
	assert_false(_world.start())
	assert_push_error("World: The world has no device")


func test_a_link_that_stood_nowhere_moves_once_it_is_put_somewhere() -> void:
	var linkage := Linkages.make_chain(1, Vector2(200, 20), Vector2(-600, 0))
	var link := linkage.get_links()[0]
	link.position.x = NAN
	await _run([linkage])
	assert_null(linkage.get_mover())
	link.position.x = 0.0
	await wait_physics_frames(70)
	assert_not_null(linkage.get_mover())
	assert_push_error("Link1: It stands at (nan")


func test_a_turn_that_is_no_number_is_told_as_it_was_given_and_the_last_one_stays() -> void:
	await _run([])
	await _break(_world, &"mapping_turn", INF, 0.5, "World: mapping_turn is inf rad")
	assert_almost_eq(_tool.global_rotation, 0.5, 0.1)


func test_a_tool_that_the_loop_pressed_into_a_wall_did_not_start_there() -> void:
	await wait_physics_frames(1)
	_world = Scene.make_world()
	_world.hold_at_start = false
	_world.gravity_source = HapticWorld2D.GravitySource.CUSTOM
	_world.gravity = Vector2(0.0, 50.0)
	_tool = Scene.make_tool()
	var wall := Scene.make_wall(Vector2(0, 61), Vector2(800, 40))
	wall.surface.stiffness = 600.0
	# in the middle of a tick, as a game spawns things: the loop steps before the scene is looked over
	add_child_autofree(Scene.gather([_world, _tool, wall]))
	await wait_physics_frames(20)
	assert_push_error_count(0)


func test_a_center_of_mass_that_breaks_does_not_blind_the_loop() -> void:
	await _run([Scene.make_wall(Vector2(0, 70), Vector2(800, 40))])
	for center: Vector2 in [Vector2(NAN, 0.0), Vector2(0.0, 1e30)]:
		_tool.center_of_mass = center
		await wait_physics_frames(20)
		assert_almost_eq(_world.get_contact_force().y, -2.0, 0.1, str(center))
