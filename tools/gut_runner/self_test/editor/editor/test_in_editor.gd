extends GutTest
## Suites in the editor pass, fail and meet errors like the others.


func test_passes_with_the_editor_at_hand() -> void:
	assert_true(Engine.is_editor_hint())
	assert_not_null(EditorInterface.get_base_control())
	await wait_physics_frames(2)
	await wait_seconds(0.05)


func test_fails() -> void:
	assert_eq(1, 2)


func test_meets_an_error() -> void:
	assert_true(true)
	push_error("in the editor")
