extends GutTest
## Every figure that a scene can hold: one that is no number, or of a size that nothing has, is
## named once, with its value, by the check of the node that it belongs to.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")
const Checks := preload("res://addons/haptics/nodes/checks.gd")
const Gateway := preload("res://addons/haptics/nodes/gateway.gd")
const LinkageReader := preload("res://addons/haptics/environment/linkage_reader.gd")
const DrawingChecks := preload("res://addons/haptics/nodes/drawing_checks.gd")
const LinkageChecks := preload("res://addons/haptics/nodes/linkage_checks.gd")

# cut to the project's ceiling, or told at the start and at the tick
const _ELSEWHERE: PackedStringArray = ["max_force", "gravity", "record_seconds"]

var _world: HapticWorld2D
var _tool: HapticTool2D
var _wall: HapticWall2D
var _object: HapticObject2D
var _linkage: HapticLinkage2D
var _link: HapticLink2D


func before_each() -> void:
	_world = Scene.make_world()
	_world.auto_start = false
	_world.safety = HapticSafetyLimits.new()
	_tool = Scene.make_tool()
	_tool.surface = HapticSurface.create(HapticSurface.Preset.WOOD)
	_wall = Scene.make_wall(Vector2(0, 400), Vector2(400, 40))
	_wall.surface = HapticSurface.create(HapticSurface.Preset.WOOD)
	_object = Scene.make_object(Vector2(400, 0), Vector2(40, 40), 0.1)
	_linkage = Linkages.make_chain(2, Vector2(200, 20), Vector2(-800, 0))
	_linkage.moves_freely = false
	_link = _linkage.get_links()[1]
	_link.has_limits = true
	_link.density = 1.0
	add_child_autofree(Scene.gather([_world, _tool, _wall, _object, _linkage]))


func _of_world() -> PackedStringArray:
	return Checks.of_world(_world)


func _of_tool() -> PackedStringArray:
	return Checks.of_tool(_tool)


func _of_wall() -> PackedStringArray:
	return Checks.of_body(_wall)


func _of_links() -> PackedStringArray:
	return LinkageChecks.of_linkage(_linkage) + LinkageChecks.of_link(_link)


# what of `subject` holds figures, with the values that none of them may have
func _figures(
	subject: Object, values: Array[float], unused: PackedStringArray
) -> Dictionary[StringName, Array]:
	var found: Dictionary[StringName, Array] = {}
	for property: Dictionary in subject.get_property_list():
		var usage: int = property["usage"]
		var called: StringName = property["name"]
		if usage & PROPERTY_USAGE_SCRIPT_VARIABLE == 0 or usage & PROPERTY_USAGE_STORAGE == 0:
			continue
		if called in _ELSEWHERE or called in unused:
			continue
		if property["type"] == TYPE_FLOAT:
			found[called] = values
		elif property["type"] == TYPE_VECTOR2:
			found[called] = [Vector2(NAN, 0.0), Vector2(0.0, 1e30)]
		elif property["type"] == TYPE_INT:
			found[called] = [-7, 1 << 40]
	return found


func _break_all(
	subject: Object, check: Callable, called := "", unused: PackedStringArray = []
) -> void:
	assert_eq(check.call() as PackedStringArray, PackedStringArray(), "sound")
	var figures := _figures(subject, [NAN, 1e30], unused)
	for property: StringName in figures:
		for value: Variant in figures[property]:
			var sound: Variant = subject.get(property)
			subject.set(property, value)
			var problems: PackedStringArray = check.call()
			subject.set(property, sound)
			var what := "%s%s = %s: %s" % [called, property, value, problems]
			if problems.size() != 1:
				fail_test("said %d times: %s" % [problems.size(), what])
				continue
			assert_string_contains(problems[0], String(property))
			if value is float and is_nan(value as float):
				assert_string_contains(problems[0], "nan")


func test_of_a_world() -> void:
	_break_all(_world, _of_world)


func test_of_safety_limits() -> void:
	_break_all(_world.safety, _of_world)


func test_of_a_simulated_device_and_its_hands() -> void:
	var device := _world.device as HapticSimulatedPantograph
	_break_all(device, _of_world)
	for kind: HapticSimulatedHand.Kind in [1, 3]:
		device.hand = HapticSimulatedHand.new()
		device.hand.kind = kind
		_break_all(device.hand, _of_world, "kind %d, " % kind)


func test_of_a_geometry() -> void:
	var device := _world.device as HapticSimulatedPantograph
	for preset: HapticPantographGeometry.Preset in [1, 2, 3, 4]:
		device.geometry = HapticPantographGeometry.create(preset)
		_break_all(device.geometry, _of_world, "preset %d, " % preset)
		_break_all(device.geometry.first, _of_world, "preset %d, first." % preset)


func test_of_a_tool_and_its_surface() -> void:
	_break_all(_tool, _of_tool)
	_break_all(_tool.surface, _of_tool)


func test_of_a_wall() -> void:
	_break_all(_wall.surface, _of_wall)


func test_of_a_link() -> void:
	# a limit may be as far as it likes; links have no grip, and their mass is their density's
	_break_all(_link, _of_links, "", ["upper_limit", "grip", "mass"])
	_link.density = 0.0
	_break_all(_link, _of_links, "", ["upper_limit", "grip", "density"])


func test_of_what_draws() -> void:
	var arrows := HapticForceArrows2D.new()
	_wall.get_parent().add_child(arrows)
	_break_all(arrows, DrawingChecks.of_arrows.bind(arrows))
	var skin := HapticShapeSkin2D.new()
	_wall.add_child(skin)
	_break_all(skin, DrawingChecks.of_skin.bind(skin))
	# said when it would be drawn, once, and in a place where there is nothing to draw
	skin.edge_width = NAN
	await wait_process_frames(3)
	skin.pointer = 1.0
	await wait_process_frames(3)
	assert_push_error("edge_width is nan px")
	skin.edge_width = 1.0
	skin.reparent(_world)
	assert_string_contains("".join(DrawingChecks.of_skin(skin)), "and World has none")
	var cursor := HapticHandCursor2D.new()
	_wall.add_child(cursor)
	await wait_process_frames(2)
	assert_push_error("is not a child of a HapticWorld2D")
	assert_push_error_count(2)


func test_of_the_motion_with_which_a_linkage_starts() -> void:
	for figure: String in ["coordinate", "rate"]:
		var description := LinkageReader.describe(_linkage, _link, HapticUnits.new(), [])
		(description["links"] as Array[Dictionary])[1][figure] = NAN
		var problems := Gateway.new().set_tool(description)
		assert_eq(problems.size(), 1, str(problems))
		assert_string_contains("".join(problems), "links[1].%s is nan" % figure)


func test_of_a_choice_in_a_file() -> void:
	_world.safety.max_force = 1.0
	var file := "user://choice.tres"
	FileAccess.open(file, FileAccess.WRITE).store_string(
		(
			'[gd_resource type="Resource" load_steps=2 format=3]\n[ext_resource type="Script"'
			+ ' path="res://addons/haptics/resources/haptic_simulated_hand.gd" id="1"]\n'
			+ '[resource]\nscript = ExtResource("1")\nkind = 9\n'
		)
	)
	(_world.device as HapticSimulatedPantograph).hand = load(file)
	assert_eq(_of_world().size(), 1)
	assert_string_contains("".join(_of_world()), 'device.hand.kind is "9", must be one of: none')
	assert_false(_world.start())
	assert_push_error('device.hand.kind is "9"')
