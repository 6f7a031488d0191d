extends GutTest
## Linkages as an author makes them: order, messages, and what the native side is given.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")
const LinkageChecks := preload("res://addons/haptics/nodes/linkage_checks.gd")
const LinkageReader := preload("res://addons/haptics/environment/linkage_reader.gd")

var _world: HapticWorld2D
var _linkage: HapticLinkage2D


func before_each() -> void:
	_world = Scene.make_world()
	_world.auto_start = false
	_linkage = Linkages.make_chain(3, Vector2(100, 20))


func _build() -> void:
	var nodes: Array[Node] = [_world, _linkage]
	add_child_autofree(Scene.gather(nodes))


func _problem() -> String:
	var problems := LinkageChecks.of_linkage(_linkage)
	return problems[0] if not problems.is_empty() else ""


func test_a_sound_linkage_says_nothing() -> void:
	_build()
	assert_eq(LinkageChecks.of_linkage(_linkage), PackedStringArray())
	for link: HapticLink2D in _linkage.get_links():
		assert_eq(LinkageChecks.of_link(link), PackedStringArray())


func test_links_come_parents_first_and_the_last_is_held_first() -> void:
	_build()
	var names := _linkage.get_links().map(func(l: Node) -> String: return l.name)
	assert_eq(names, ["Link1", "Link2", "Link3"])
	assert_eq(_world.get_tool().name, &"Link3")
	_linkage.start_link = _linkage.get_links()[1]
	assert_eq(_world.get_tool().name, &"Link2")


func test_a_rigid_tool_comes_before_a_linkage() -> void:
	var tool := Scene.make_tool(Vector2(0, 400))
	var nodes: Array[Node] = [_world, _linkage, tool]
	add_child_autofree(Scene.gather(nodes))
	assert_same(_world.get_tool(), tool)


func test_angles_and_limits_are_those_of_y_up() -> void:
	var link := _linkage.get_links()[1]
	link.has_limits = true
	link.lower_limit = -0.2
	link.upper_limit = 0.7
	_build()
	var units := HapticUnits.new(4000.0)
	var described := LinkageReader.describe(_linkage, link, units, PackedStringArray())
	var second: Dictionary = (described["links"] as Array)[1]
	assert_eq(second["limits"], PackedFloat64Array([-0.7, 0.2]))
	var frame: PackedFloat64Array = second["frame"]
	assert_almost_eq(frame[0], 0.025, 1e-9)
	assert_almost_eq(frame[2], -0.5, 1e-6)
	assert_eq(described["grip_link"], 1)


func test_a_linkage_without_links() -> void:
	# the others are below it
	_linkage.get_links()[0].free()
	_build()
	assert_string_contains(_problem(), "It has no links. Add a HapticLink2D")


func test_a_link_without_mass_is_named() -> void:
	_linkage.get_links()[1].mass = 0.0
	_build()
	assert_string_contains(_problem(), "Link2.mass is 0")


func test_a_density_gives_the_mass_of_the_area() -> void:
	var link := _linkage.get_links()[0]
	link.mass = 0.0
	link.density = 10.0
	_build()
	assert_eq(_problem(), "")


func test_limits_out_of_order_are_named() -> void:
	var link := _linkage.get_links()[2]
	link.has_limits = true
	link.lower_limit = 1.0
	link.upper_limit = -1.0
	_build()
	assert_string_contains(
		LinkageChecks.of_link(link)[0], "lower_limit is 1.0 and upper_limit -1.0"
	)
	assert_eq(_problem(), "", "said once, by the link")


func test_limits_that_are_no_numbers_are_named_as_they_are() -> void:
	var link := _linkage.get_links()[2]
	link.has_limits = true
	_build()
	for limit: StringName in [&"lower_limit", &"upper_limit"]:
		link.set(limit, NAN)
		assert_string_contains(LinkageChecks.of_link(link)[0], "%s is nan" % limit)
		assert_eq(_problem(), "")
		link.set(limit, 1.0 if limit == &"upper_limit" else -1.0)


func test_a_floating_linkage_with_two_roots() -> void:
	_linkage.grounded = false
	_linkage.add_child(Linkages.make_link("Stray", Vector2(50, 20)))
	_build()
	assert_string_contains(_problem(), "It floats, but 2 links stand directly below it: Stray")


func test_all_joints_fixed() -> void:
	for link: HapticLink2D in _linkage.get_links():
		link.joint = HapticLink2D.Joint.FIXED
	_build()
	assert_ne(_problem(), "")


func test_a_link_without_a_linkage() -> void:
	_world.free()
	_linkage.free()
	var stray := Linkages.make_link("Stray", Vector2(50, 20))
	add_child_autofree(Scene.gather([stray] as Array[Node]))
	assert_string_contains(LinkageChecks.of_link(stray)[0], "which is no HapticLinkage2D")
	await wait_physics_frames(2)
	assert_push_error("Stray: It stands below Scene")
