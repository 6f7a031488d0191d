extends GutTest
## Clutch, mapping and turn while the world runs: the tool stays, nothing jumps.

const Scene := preload("res://tests/support/haptic_scene.gd")

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# the hand presses the tool on a wall below, as far as its spring lets it
func _press() -> void:
	_world = Scene.make_world()
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.2, 0.0, 0.004, 0.0]]
	)
	_tool = Scene.make_tool()
	var wall := Scene.make_wall(Vector2(0, 60), Vector2(800, 30))
	add_child_autofree(Scene.gather([_world, _tool, wall]))
	await wait_physics_frames(150)


func test_the_clutch_frees_the_handle_and_leaves_the_tool() -> void:
	await _press()
	var pressed := _world.get_force().length()
	assert_gt(pressed, 0.5)
	var at := _tool.global_position
	_world.clutched = true
	await wait_physics_frames(60)
	assert_eq(_world.get_force(), Vector2.ZERO)
	assert_almost_eq(_tool.global_position, at, Vector2(1.0, 1.0))
	assert_gt(_world.get_contact_force().length(), 0.5 * pressed)
	_world.clutched = false
	await wait_physics_frames(60)
	assert_gt(_world.get_force().length(), 0.1)
	assert_almost_eq(_tool.global_position, at, Vector2(4.0, 4.0))


func test_a_new_scale_leaves_the_tool_where_it_is() -> void:
	await _press()
	var at := _tool.global_position
	_world.mapping_scale = 2.0
	await wait_physics_frames(90)
	assert_almost_eq(_tool.global_position, at, Vector2(6.0, 6.0))
	assert_eq(_world.get_faults(), PackedStringArray())


func test_the_scene_turns_the_tool() -> void:
	var world := Scene.make_world()
	var tool := Scene.make_tool()
	add_child_autofree(Scene.gather([world, tool]))
	await wait_physics_frames(30)
	world.mapping_turn = 2.5 * PI
	await wait_physics_frames(150)
	assert_almost_eq(tool.global_rotation, 0.5 * PI, 0.02)
	assert_lt(world.get_force().length(), 0.05)


func test_a_scale_out_of_range_is_named_and_changes_nothing() -> void:
	await _press()
	_world.mapping_scale = 0.0
	await wait_physics_frames(2)
	assert_push_error("mapping_scale is 0")
	assert_true(_world.is_running())
	_world.mapping_scale = 1.0
	await wait_physics_frames(2)
