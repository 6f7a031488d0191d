extends GutTest
## Settings that are changed while the world runs: some count at once, of the others it is said,
## once each, that they count from the next start.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _press() -> void:
	_world = Scene.make_world(Vector2(0.0, 2.0), 0.1)
	_world.safety = HapticSafetyLimits.new()
	_tool = Scene.make_tool()
	var wall := StaticBody2D.new()
	wall.position.y = 70.0
	wall.add_child(Scene.make_box(Vector2(480, 40)))
	add_child_autofree(Scene.gather([_world, _tool, wall]))
	await wait_physics_frames(60)


# what was said, by what it was said of
func _warnings() -> Dictionary[String, int]:
	var said: Dictionary[String, int] = {}
	for error: GutTrackedError in get_errors():
		if error.is_push_warning() and not error.handled:
			error.handled = true
			var text := error.code + error.rationale
			assert_string_contains(text, "World: ")
			assert_string_contains(text, "Call stop() and start()")
			var called := text.get_slice("World: ", 1).get_slice(" is ", 0)
			said[called] = said.get(called, 0) + 1
	return said


func test_what_counts_from_the_next_start_says_so_once() -> void:
	await _press()
	assert_eq(_warnings().size(), 0)
	var device := _world.device as HapticSimulatedPantograph
	var changes: Dictionary[String, Callable] = {
		"rate": func() -> void: _world.rate = 500.0,
		"pixels_per_meter": func() -> void: _world.pixels_per_meter = 2000.0,
		"coupling": func() -> void: _world.coupling = HapticWorld2D.Coupling.DIRECT,
		"integrator": func() -> void: _world.integrator = HapticWorld2D.Integrator.EXACT,
		"coupling_stiffness": func() -> void: _world.coupling_stiffness = 500.0,
		"record_seconds": func() -> void: _world.record_seconds = 1.0,
		"safety.max_force": func() -> void: _world.safety.max_force = 3.0,
		"device.hand.force": func() -> void: device.hand.force = Vector2(0.0, 1.0),
		"device.measures_force": func() -> void: device.measures_force = false,
		"Tool.mass": func() -> void: _tool.mass = 0.5,
		"Tool.grip_point": func() -> void: _tool.grip_point = Vector2(3, 0),
		"Tool.surface": func() -> void: _tool.surface = HapticSurface.new(),
	}
	for called: String in changes:
		changes[called].call()
	for turn: int in 2:
		await wait_physics_frames(40)
		var said := _warnings()
		for called: String in changes:
			assert_eq(said.get(called, 0), 1 - turn, called)
			said.erase(called)
		assert_eq(said.size(), 0, str(said))
		_tool.mass = 0.6
	assert_almost_eq(_world.get_force().y, -2.0, 0.02)
	assert_eq(_world.get_statistics()["haptic_rate_hz"], 1000.0)
	_world.coupling = HapticWorld2D.Coupling.FOUR_CHANNEL
	device.measures_force = true
	_world.stop()
	_tool.position = Vector2.ZERO
	assert_true(_world.start())
	assert_eq(_world.get_statistics()["haptic_rate_hz"], 500.0)
	await wait_physics_frames(40)
	assert_eq(_warnings().size(), 0)


func test_what_counts_at_once_says_nothing() -> void:
	await _press()
	_world.default_surface = HapticSurface.new()
	_world.default_surface.stiffness = 7500.0
	_world.gravity_source = HapticWorld2D.GravitySource.CUSTOM
	_world.gravity = Vector2(0.0, 1.0)
	await wait_physics_frames(60)
	assert_almost_eq(_world.get_penetration(), 2.3 / 7500.0, 6e-6)
	_tool.collision_mask = 2
	await wait_physics_frames(60)
	assert_eq(_world.get_contacts().size(), 0)
	assert_eq(_warnings().size(), 0)


func test_a_link_that_is_held_keeps_its_joint_until_the_next_start() -> void:
	_world = Scene.make_world()
	var linkage := Linkages.make_chain(2, Vector2(200, 20))
	add_child_autofree(Scene.gather([_world, linkage]))
	await wait_physics_frames(20)
	var first := linkage.get_links()[0]
	assert_true(linkage.grab(first, Vector2(100, 0)))
	first.joint_damping = 0.01
	linkage.moves_freely = false
	await wait_physics_frames(40)
	assert_eq(_warnings(), {"Link1.joint_damping": 1} as Dictionary[String, int])
