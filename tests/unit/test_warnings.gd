extends GutTest
## Bad input: one clear message that names the node, the value and the fix, and the rest runs on.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Checks := preload("res://addons/haptics/nodes/checks.gd")

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func before_each() -> void:
	_world = Scene.make_world()
	_tool = Scene.make_tool()


func _run(more: Array[Node] = []) -> Node2D:
	var nodes: Array[Node] = [_world, _tool]
	var scene: Node2D = add_child_autofree(Scene.gather(nodes + more))
	await wait_physics_frames(3)
	return scene


func test_a_sound_scene_says_nothing_and_runs() -> void:
	await _run([Scene.make_wall(Vector2(0, 100), Vector2(400, 40))])
	assert_true(_world.is_running())
	assert_eq(Checks.of_world(_world) + Checks.of_tool(_tool), PackedStringArray())


func test_a_tool_without_mass() -> void:
	_tool.mass = 0.0
	await _run()
	assert_push_error("Tool: tool.mass is 0")
	assert_false(_world.is_running())


func test_a_tool_of_negative_mass() -> void:
	_tool.mass = -0.5
	await _run()
	assert_push_error("Tool: tool.mass is -0.5")


func test_a_mass_that_is_not_a_number() -> void:
	_tool.mass = NAN
	await _run()
	assert_push_error("Tool: tool.mass is")


func test_a_tool_without_a_shape() -> void:
	_tool.get_child(0).free()
	await _run()
	assert_push_error("Tool: The tool has no shape. Add a CollisionShape2D")


func test_a_tool_with_an_empty_shape() -> void:
	(_tool.get_child(0) as CollisionShape2D).shape = null
	await _run()
	assert_push_error("Tool: Shape has no shape. Give it one")


func test_a_tool_that_starts_inside_of_a_wall() -> void:
	await _run([Scene.make_wall(Vector2(0, 50), Vector2(400, 40))])
	assert_push_error("Tool: It starts inside of Wall, at (0.0, 0.0)")
	assert_true(_world.is_running())


func test_a_tool_that_touches_a_wall_is_fine() -> void:
	await _run([Scene.make_wall(Vector2(0, 60), Vector2(400, 40))])
	assert_true(_world.is_running())


func test_two_tools_in_one_world() -> void:
	var second := Scene.make_tool(Vector2(300, 0))
	second.name = "Second"
	await _run([second])
	assert_push_error("Second: World already has the tool Tool")
	assert_true(_world.is_running())


func test_a_world_without_a_device() -> void:
	_world.device = null
	await _run()
	assert_push_error("World: The world has no device. Set its device")
	assert_false(_world.is_running())


func test_a_world_without_a_tool() -> void:
	_tool.free()
	_tool = null
	add_child_autofree(Scene.gather([_world]))
	await wait_physics_frames(3)
	assert_push_error("World: The world has no tool. Add a HapticTool2D")


func test_a_tool_without_a_world() -> void:
	_world.free()
	add_child_autofree(Scene.gather([_tool]))
	await wait_physics_frames(3)
	assert_push_error("Tool: There is no HapticWorld2D in this scene. Add one")


func test_two_worlds_in_one_world_2d() -> void:
	var second := Scene.make_world()
	second.name = "Second"
	await _run([second])
	assert_push_error("There are two haptic worlds in one World2D: World and Second")
	assert_true(_world.is_running())
	assert_false(second.is_running())


func test_a_scaled_world() -> void:
	_world.scale = Vector2(2, 2)
	await _run()
	assert_push_error("World: The world's scale is (2.0, 2.0)")


func test_a_rate_out_of_range() -> void:
	_world.rate = 50.0
	await _run()
	assert_push_error("World: ")
	assert_false(_world.is_running())


func test_a_collision_speed_of_zero() -> void:
	_world.collision_speed = 0.0
	await _run()
	assert_push_error("World: collision_speed is 0 m/s")
	assert_false(_world.is_running())


func test_a_force_limit_that_is_not_a_number() -> void:
	_world.safety = HapticSafetyLimits.new()
	_world.safety.max_force = NAN
	await _run()
	assert_push_error("World: max_force is nan N")
	assert_false(_world.is_running())


func test_gravity_that_is_not_a_number() -> void:
	_world.gravity_source = HapticWorld2D.GravitySource.CUSTOM
	_world.gravity = Vector2(NAN, 0.0)
	await _run()
	assert_push_error("World: gravity is (nan")


func test_a_tool_that_is_nowhere() -> void:
	_tool.position = Vector2(NAN, 0.0)
	await _run()
	assert_push_error("Tool: The tool stands at (nan")
	assert_false(_world.is_running())


func test_a_tool_without_area() -> void:
	(_tool.get_child(0) as CollisionShape2D).shape = WorldBoundaryShape2D.new()
	await _run()
	assert_push_error("Its shapes have no area")


func test_pixels_per_meter_of_zero() -> void:
	_world.pixels_per_meter = 0.0
	await _run()
	assert_push_error("World: pixels_per_meter is 0")
	assert_false(_world.is_running())


func test_a_path_with_more_points_than_times() -> void:
	var device := _world.device as HapticSimulatedPantograph
	device.hand = Scene.make_path([[0.0, 0.0, 0.0, 0.0], [1.0, 0.01, 0.0, 0.0]])
	device.hand.path_times.resize(1)
	await _run()
	assert_push_error("World: The hand's path has 2 points and 1 times")


class TestBodies:
	extends GutTest

	func _run(body: Node) -> void:
		var nodes: Array[Node] = [Scene.make_world(), Scene.make_tool(Vector2(-800, 0)), body]
		add_child_autofree(Scene.gather(nodes))
		await wait_physics_frames(3)

	func _make_wall(points: PackedVector2Array) -> HapticWall2D:
		var wall := HapticWall2D.new()
		wall.name = "Wall"
		wall.add_child(Scene.make_outline(points))
		return wall

	func test_a_wall_without_a_shape() -> void:
		var wall := HapticWall2D.new()
		wall.name = "Wall"
		await _run(wall)
		assert_push_error("Wall: shapes is empty. Give the body a collision shape.")

	func test_an_outline_of_two_points() -> void:
		await _run(_make_wall([Vector2.ZERO, Vector2(50, 0)]))
		assert_push_error("Wall: Outline has an outline of 2 points")

	func test_an_outline_that_crosses_itself() -> void:
		await _run(_make_wall([Vector2(0, 0), Vector2(80, 80), Vector2(80, 0), Vector2(0, 60)]))
		assert_push_error("Wall: shapes[0]")

	func test_an_outline_with_a_corner_that_is_not_a_number() -> void:
		var wall := HapticWall2D.new()
		wall.name = "Wall"
		var segment := SegmentShape2D.new()
		segment.a = Vector2(NAN, 0)
		var holder := CollisionShape2D.new()
		holder.shape = segment
		wall.add_child(holder)
		wall.collision_layer = 0
		await _run(wall)
		assert_push_error("Wall: shapes[0].points holds a number that is not finite")

	func test_a_surface_of_negative_stiffness() -> void:
		var wall := Scene.make_wall(Vector2.ZERO, Vector2(50, 50))
		wall.surface.stiffness = -1.0
		await _run(wall)
		assert_push_error("Wall: surface.stiffness is -1")

	func test_a_scaled_object() -> void:
		var object := Scene.make_object(Vector2.ZERO, Vector2(50, 50), 0.1)
		object.scale = Vector2(2, 1)
		assert_string_contains(_first(await _check(object)), "The scale is (2.0, 1.0)")
		assert_push_error("Object: The scale is (2.0, 1.0)")

	# before physics takes the scale away
	func _check(object: HapticObject2D) -> PackedStringArray:
		var nodes: Array[Node] = [Scene.make_world(), Scene.make_tool(Vector2(-800, 0)), object]
		add_child_autofree(Scene.gather(nodes))
		var problems := Checks.of_object(object)
		await wait_physics_frames(2)
		return problems

	func _first(problems: PackedStringArray) -> String:
		return problems[0] if not problems.is_empty() else ""


class TestTelling:
	extends GutTest

	const Warnings := preload("res://addons/haptics/nodes/warnings.gd")

	func test_the_same_thing_is_said_once() -> void:
		var node: Node = add_child_autofree(Node.new())
		var warnings := Warnings.new(node, Callable())
		warnings.say_these(["broken", "broken"])
		warnings.say_these(["broken"])
		assert_push_error_count(1)

	func test_every_message_names_its_node() -> void:
		var node: Node = add_child_autofree(Node.new())
		node.name = "Particular"
		Warnings.new(node, Callable()).say_these(["broken"])
		assert_push_error("Particular: broken")
