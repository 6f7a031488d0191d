extends GutTest
## The settings of project.godot that the rest of the house relies on.


func test_the_engine_is_4_6_or_newer() -> void:
	assert_gte(Engine.get_version_info()["hex"] as int, 0x040600)


func test_physics_ticks_are_the_default_60_a_second() -> void:
	assert_eq(Engine.physics_ticks_per_second, 60)


func test_the_project_needs_no_autoload() -> void:
	var autoloads: PackedStringArray = []
	for property: Dictionary in ProjectSettings.get_property_list():
		if (property["name"] as String).begins_with("autoload/"):
			autoloads.append(property["name"] as String)
	assert_eq(autoloads, PackedStringArray())


class TestDrawing:
	extends GutTest

	func test_scenes_are_laid_out_for_1280_by_720_and_scale_with_the_window() -> void:
		assert_eq(ProjectSettings.get_setting("display/window/size/viewport_width"), 1280)
		assert_eq(ProjectSettings.get_setting("display/window/size/viewport_height"), 720)
		assert_eq(ProjectSettings.get_setting("display/window/stretch/mode"), "canvas_items")

	func test_the_renderer_is_the_one_that_every_machine_has() -> void:
		var setting := "rendering/renderer/rendering_method"
		assert_eq(ProjectSettings.get_setting(setting), "gl_compatibility")


class TestTyping:
	extends GutTest

	const UNTYPED := "extends Node\nvar untyped = 3\n"

	func test_untyped_declarations_are_errors(
		folder: String = use_parameters(
			["res://addons/haptics", "res://addons/haptics_training", "res://scenes", "res://tests"]
		)
	) -> void:
		# the engine itself says so: the same source does not compile there
		assert_eq(_compile(folder), ERR_PARSE_ERROR)
		assert_engine_error("has no static type")

	func test_addons_of_others_are_left_alone() -> void:
		assert_eq(_compile("res://addons/someone_elses"), OK)

	func _compile(folder: String) -> Error:
		var script := GDScript.new()
		script.resource_path = folder.path_join("not_a_file.gd")
		script.source_code = UNTYPED
		return script.reload()
