extends GutTest
## Errors that a test expects do not fail it.


func test_push_error() -> void:
	push_error("First Message")
	push_error("second message")
	assert_push_error("first mess")
	assert_push_error("SECOND")


func test_push_error_count() -> void:
	push_error("one")
	push_error("two")
	assert_push_error_count(2)


func test_no_errors() -> void:
	assert_push_error_count(0)
	assert_engine_error_count(0)
	assert_push_warning_count(0)


func test_engine_error() -> void:
	remove_child(autofree(Node.new()) as Node)
	assert_engine_error("DATA.PARENT != THIS")


func test_script_error() -> void:
	_call_what_is_missing(RefCounted.new())
	assert_engine_error("nonexistent function")
	assert_engine_error_count(1)


func test_warnings_never_fail() -> void:
	push_warning("Careful")
	push_warning("again")
	assert_push_warning("careful")
	assert_push_warning_count(2)


func test_error_of_another_thread() -> void:
	var thread: Thread = Thread.new()
	thread.start(func() -> void: push_error("from afar"))
	thread.wait_to_finish()
	assert_push_error("from afar")


func test_judging_errors_by_hand() -> void:
	push_error("mine")
	assert_eq(get_errors().size(), 1)
	for error: GutTrackedError in get_errors():
		assert_true(error.is_push_error())
		assert_true(error.contains_text("MINE"))
		error.handled = true


func _call_what_is_missing(object: Variant) -> void:
	object.there_is_no_such_function()
