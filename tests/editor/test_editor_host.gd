extends GutTest
## The suites of this folder run inside of the editor: they have EditorInterface at hand.


func test_runs_inside_the_editor() -> void:
	assert_true(Engine.is_editor_hint())
	assert_is(EditorInterface.get_base_control(), Control)


func test_can_open_a_scene_and_edit_its_root() -> void:
	var root: Node2D = Node2D.new()
	root.name = "Root"
	var scene: PackedScene = PackedScene.new()
	assert_eq(scene.pack(root), OK)
	root.free()
	var path: String = "res://.godot/editor_host_test.tscn"
	assert_eq(ResourceSaver.save(scene, path), OK)
	EditorInterface.open_scene_from_path(path)
	await wait_process_frames(2)
	assert_eq(EditorInterface.get_edited_scene_root().name, &"Root")
	assert_eq(EditorInterface.close_scene(), OK)
