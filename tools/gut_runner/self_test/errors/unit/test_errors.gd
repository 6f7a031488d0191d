extends GutTest
## Errors that no test expected, and asserts about errors that did not come.


func test_push_error_fails() -> void:
	assert_true(true)
	push_error("nobody expected this")


func test_engine_error_fails() -> void:
	assert_true(true)
	remove_child(autofree(Node.new()) as Node)


func test_script_error_fails() -> void:
	assert_true(true)
	var nothing: Variant = null
	nothing.call_it()
	assert_true(true)


func test_script_error_after_an_await_fails() -> void:
	assert_true(true)
	await wait_process_frames(1)
	var nothing: Variant = null
	nothing.call_it()


func test_error_of_another_thread_fails() -> void:
	assert_true(true)
	var thread: Thread = Thread.new()
	thread.start(func() -> void: push_error("from afar"))
	thread.wait_to_finish()


func test_one_error_more_than_expected_fails() -> void:
	push_error("one")
	push_error("one")
	assert_push_error("one")


func test_missing_push_error_fails() -> void:
	assert_push_error("anything")


func test_missing_engine_error_fails() -> void:
	push_error("this is not the engine")
	assert_push_error("this is not")
	assert_engine_error("this is not")


func test_wrong_count_fails() -> void:
	push_error("one")
	assert_push_error_count(2)


func test_missing_warning_fails() -> void:
	assert_push_warning("careful")


func test_asserting_nothing_fails() -> void:
	pass


func test_warning_alone_passes() -> void:
	push_warning("careful")
	assert_true(true)
