extends GutTest
## A real device that is not there: one clear message that names what is missing and the fix.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Checks := preload("res://addons/haptics/nodes/checks.gd")

const LIBRARY := "HAPTICS_HIDAPI"

var _device: HapticHidPantograph
var _world: HapticWorld2D
var _library_before: String


func before_each() -> void:
	_library_before = OS.get_environment(LIBRARY)
	_device = HapticHidPantograph.new()
	_world = autofree(Scene.make_world())
	_world.mode = HapticWorld2D.Mode.REALTIME
	_world.device = _device


func after_each() -> void:
	if _library_before.is_empty():
		OS.unset_environment(LIBRARY)
	else:
		OS.set_environment(LIBRARY, _library_before)


func _run() -> void:
	var nodes: Array[Node] = [_world, Scene.make_tool()]
	add_child_autofree(Scene.gather(nodes))
	await wait_physics_frames(3)


func test_a_sound_device_has_no_warnings_before_it_is_opened() -> void:
	_world.auto_start = false
	await _run()
	assert_eq(Checks.of_world(_world), PackedStringArray())
	assert_false(_world.is_running())


func test_without_hidapi_the_message_says_how_to_get_it() -> void:
	OS.set_environment(LIBRARY, "/nonexistent/libhidapi.so")
	await _run()
	assert_push_error("World: The library hidapi, which talks to the device, could not be loaded")
	assert_false(_world.is_running())


func test_without_a_device_the_message_says_what_was_looked_for() -> void:
	OS.set_environment(LIBRARY, OS.get_environment("HAPTICS_TEST_HIDAPI"))
	# an id of nobody's
	_device.vendor_id = 0xFFFE
	_device.product_id = 0xFFFD
	await _run()
	assert_push_error("fffe:fffd is plugged in. Plug it in, or set vendor_id and product_id")
	assert_false(_world.is_running())


func test_a_vendor_of_zero() -> void:
	_device.vendor_id = 0
	await _run()
	assert_push_error("World: vendor_id is 0")
	assert_false(_world.is_running())


func test_a_product_out_of_range() -> void:
	_device.product_id = 70000
	await _run()
	assert_push_error("World: product_id is 70000")


func test_a_tolerance_that_is_not_a_number() -> void:
	_device.encoder_tolerance = NAN
	await _run()
	assert_push_error("World: encoder_tolerance is")


func test_a_joint_that_stands() -> void:
	_device.max_joint_speed = 0.0
	await _run()
	assert_push_error("World: max_joint_speed is 0")


func test_lock_step_needs_a_simulated_device() -> void:
	_world.mode = HapticWorld2D.Mode.LOCKSTEP
	await _run()
	assert_push_error("World: A HapticHidPantograph needs the mode REALTIME")
	assert_false(_world.is_running())


func test_a_kind_of_device_that_nobody_knows() -> void:
	var native := HapticWorld2D.Gateway.new()
	var problems := native.set_device({"kind": "telepathy"})
	assert_eq(problems.size(), 1)
	assert_string_contains(problems[0], 'device.kind is "telepathy", must be one of')


func test_homing_a_world_that_does_not_run() -> void:
	_world.auto_start = false
	await _run()
	assert_eq(_world.home_device(), FAILED)
	assert_push_error("the world does not run, so no device can be homed")


func test_homing_a_simulated_device_does_nothing() -> void:
	_world.device = HapticSimulatedPantograph.new()
	await _run()
	assert_true(_world.is_running())
	assert_eq(_world.home_device(), OK)


func test_a_change_is_told() -> void:
	watch_signals(_device)
	_device.serial = "A-17"
	assert_signal_emitted(_device, "changed")
