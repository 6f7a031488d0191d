extends GutTest
## Buttons of a device: what a game hears of them, and grabbing with one.

const Scene := preload("res://tests/support/haptic_scene.gd")

var _world: HapticWorld2D
var _tool: HapticTool2D
var _heard: Array[Array] = []


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func before_each() -> void:
	_heard = []
	_world = Scene.make_world()
	_world.button_changed.connect(_hear)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(20, 20))


func _hear(button: int, pressed: bool) -> void:
	_heard.append([button, pressed])


# what the device of the next report holds down: simulated ones have no buttons
func _press(buttons: int) -> void:
	_world._buttons.tell(buttons)


func test_a_button_is_told_when_it_goes_down_and_up() -> void:
	add_child_autofree(Scene.gather([_world, _tool]))
	await wait_physics_frames(3)
	assert_eq(_heard, [] as Array[Array])
	_press(0b101)
	assert_true(_world.is_button_pressed(0))
	assert_false(_world.is_button_pressed(1))
	assert_true(_world.is_button_pressed(2))
	assert_false(_world.is_button_pressed(-1))
	assert_false(_world.is_button_pressed(32))
	_press(0b101)
	_press(0b100)
	assert_eq(_heard, [[0, true], [2, true], [0, false]] as Array[Array])
	# the report of the next tick knows that no button is down
	await wait_physics_frames(2)
	assert_eq(_heard.back(), [2, false])
	assert_false(_world.is_button_pressed(2))


func test_a_loop_that_starts_anew_lets_no_button_go() -> void:
	add_child_autofree(Scene.gather([_world, _tool]))
	await wait_physics_frames(3)
	_press(1)
	_world.stop()
	_world._buttons.follow()
	assert_true(_world.is_button_pressed(0))
	assert_true(_world.start())
	# no step yet, so nothing is known of buttons
	_world._buttons.follow()
	assert_eq(_heard, [[0, true]] as Array[Array])


# as docs/linkages.md has it
func test_a_body_is_grabbed_with_a_button_and_let_go() -> void:
	var object := Scene.make_object(Vector2(4, 0), Vector2(60, 60), 0.1)
	_tool.collision_mask = 2
	var grab := func(button: int, pressed: bool) -> void:
		if button == 0 and pressed:
			_world.take_at(_world.get_grip().origin)
		elif button == 0:
			_world.take(_tool)
	_world.button_changed.connect(grab)
	add_child_autofree(Scene.gather([_world, _tool, object]))
	await wait_physics_frames(20)
	assert_same(_world.get_tool(), _tool)
	# in the physics tick, as the world does it
	await get_tree().physics_frame
	_press(1)
	assert_same(_world.get_held_body(), object)
	assert_true(object.freeze)
	_world._buttons.tell(0)
	assert_null(_world.get_held_body())
	assert_same(_world.get_tool(), _tool)
	assert_false(object.freeze)
	assert_true(_world.is_running())


func test_what_is_held_is_taken_only_where_nothing_else_lies() -> void:
	add_child_autofree(Scene.gather([_world, _tool]))
	await wait_physics_frames(3)
	await get_tree().physics_frame
	assert_true(_world.take_at(_world.get_grip().origin))
	assert_same(_world.get_tool(), _tool)
	assert_false(_world.take_at(Vector2(500, 500)))
