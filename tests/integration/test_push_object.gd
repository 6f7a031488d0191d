extends GutTest
## The tool pushes an object, and the object pushes back.

const Scene := preload("res://tests/support/haptic_scene.gd")


# spins a body at `rate` (rad/s) in each physics tick
class Spinner:
	extends Node
	var body: RigidBody2D
	var rate := 0.0

	func _physics_process(_delta: float) -> void:
		body.angular_velocity = rate


var _world: HapticWorld2D
var _tool: HapticTool2D
var _object: HapticObject2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _push(path: Array[PackedFloat64Array], mass: float, ticks: int) -> void:
	_world = Scene.make_world()
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(path)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	_object = Scene.make_object(Vector2(90, 0), Vector2(80, 80), mass)
	add_child_autofree(Scene.gather([_world, _tool, _object]))
	await wait_physics_frames(ticks)


func test_an_object_is_carried_along_and_flies_on() -> void:
	# 20 mm in 0.5 s, then stop: the object leaves with about the tool's speed
	await _push([[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.2, 0.02, 0.0, 0.0]], 0.1, 90)
	assert_eq(_world.get_faults(), PackedStringArray())
	var speed := _object.linear_velocity.x / _world.pixels_per_meter
	assert_between(speed, 0.02, 0.2)
	assert_almost_eq(_object.linear_velocity.y, 0.0, 2.0)
	assert_almost_eq(_object.angular_velocity, 0.0, 0.05)
	assert_gt(_object.position.x, 150.0)
	# the tool never went through it
	assert_gt(_object.position.x - _tool.position.x, 79.0)


func test_pushing_through_drag_takes_the_force_of_the_drag() -> void:
	_world = Scene.make_world()
	_world.record_seconds = 3.0
	var hand := Scene.make_path([[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.7, 0.06, 0.0, 0.0]])
	hand.smooth = false
	(_world.device as HapticSimulatedPantograph).hand = hand
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	_object = Scene.make_object(Vector2(82, 0), Vector2(80, 80), 0.5)
	_object.linear_damp = 5.0
	add_child_autofree(Scene.gather([_world, _tool, _object]))
	# the hand stops at 1.7 s
	await wait_physics_frames(100)
	# mass times damping times speed; Godot takes 8 % of the speed at once at every tick, and the
	# loop gives it back in taps
	var drag := 0.5 * 5.0 * 0.06
	assert_almost_eq(_impulse(1.1, 1.6) / 0.5, drag, 0.1 * drag)
	assert_between(_object.linear_velocity.x, 0.9 * 240.0 * (1.0 - 5.0 / 60.0), 1.1 * 240.0)


func test_momentum_given_is_momentum_taken() -> void:
	_world = Scene.make_world()
	_world.record_seconds = 3.0
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.2, 0.02, 0.0, 0.0]]
	)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	_object = Scene.make_object(Vector2(90, 0), Vector2(80, 80), 0.2)
	add_child_autofree(Scene.gather([_world, _tool, _object]))
	await wait_physics_frames(110)
	var momentum := 0.2 * _object.linear_velocity.x / _world.pixels_per_meter
	assert_gt(momentum, 0.005)
	assert_almost_eq(_impulse(0.0, 2.0), momentum, 0.01 * momentum)


# what the loop says that it pushed between two times, contact forces and collisions, N s
func _impulse(from: float, to: float) -> float:
	var file := OS.get_user_data_dir().path_join("push.csv")
	assert_eq(_world.save_recording(file), OK)
	var rows := FileAccess.get_file_as_string(file).split("\n", false)
	var columns := rows[0].split(",")
	var given := 0.0
	for row: String in rows.slice(1):
		var values := row.split(",")
		var time := values[columns.find("t_s")].to_float()
		if time > from and time <= to:
			given -= values[columns.find("contact_force_x_n")].to_float() * 0.001
			given -= values[columns.find("impulse_x_n")].to_float() * 0.001
	return given


func test_a_heavy_object_does_not_give_way_and_a_light_one_does_not_explode() -> void:
	for mass: float in [100.0, 0.001]:
		await _push([[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.2, 0.01, 0.0, 0.0]], mass, 90)
		var speed := _object.linear_velocity.length() / _world.pixels_per_meter
		assert_lt(speed, 0.5, "mass %s kg" % mass)
		assert_gt(_object.position.x - _tool.position.x, 78.0, "mass %s kg" % mass)
		_world.get_parent().queue_free()
		await wait_physics_frames(2)


func test_an_object_moves_the_tool_that_stands_in_its_way() -> void:
	_world = Scene.make_world()
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	_object = Scene.make_object(Vector2(150, 0), Vector2(80, 80), 0.5)
	_object.linear_velocity = Vector2(-200, 0)
	add_child_autofree(Scene.gather([_world, _tool, _object]))
	watch_signals(_tool)
	await wait_physics_frames(60)
	assert_signal_emitted(_tool, "contact_began")
	assert_gt(_object.linear_velocity.x, -200.0)
	assert_lt(_tool.position.x, -1.0)


func test_what_happens_is_told() -> void:
	_world = Scene.make_world()
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.0, 0.01, 0.0, 0.0], [1.3, 0.0, 0.0, 0.0]]
	)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	var wall := Scene.make_wall(Vector2(80, 0), Vector2(40, 400))
	wall.position.x = 90.0
	add_child_autofree(Scene.gather([_world, _tool, wall]))
	watch_signals(_tool)
	await wait_physics_frames(110)
	assert_signal_emitted(_tool, "contact_began")
	assert_signal_emitted(_tool, "impacted")
	assert_signal_emitted(_tool, "contact_ended")
	var contact: HapticContact = get_signal_parameters(_tool, "contact_began", 0)[0]
	assert_same(contact.body, wall)
	assert_almost_eq(contact.normal, Vector2(-1, 0), Vector2(0.01, 0.01))
	assert_almost_eq(contact.position.x, 70.0, 2.0)


func test_a_body_whose_motion_is_no_number_is_left_out_by_name() -> void:
	_world = Scene.make_world()
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(80, 80))
	_object = Scene.make_object(Vector2(90, 0), Vector2(80, 80), 0.5)
	# no number while the world looks, and none left for the engine
	for rate: float in [NAN, 0.0]:
		var spinner := Spinner.new()
		spinner.body = _object
		spinner.rate = rate
		spinner.process_physics_priority = -1000 if is_nan(rate) else 1000000
		_object.add_child(spinner)
	add_child_autofree(Scene.gather([_world, _tool, _object]))
	await wait_physics_frames(20)
	assert_push_error("/Object was left out: its pose is (0.0")
	assert_push_error_count(1)
	assert_true(_world.is_running())
	assert_eq(_world.get_faults(), PackedStringArray())
