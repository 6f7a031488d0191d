extends "res://addons/gut/assert_signals.gd"
## Asserts on what the engine, push_error and push_warning reported during the test.
## An error that none of these accounts for fails the test.


## Every error and warning of the test so far; set [member GutTrackedError.handled] to accept one.
func get_errors() -> Array:
	return gut.error_log.peek()


## The engine or a script reported an error that contains [param text], in any letter case.
func assert_engine_error(text: String, msg: String = "") -> void:
	_assert_text(text, "engine error", &"is_engine_error", msg)


## The engine and scripts reported exactly that many errors.
func assert_engine_error_count(count: int, msg: String = "") -> void:
	_assert_count(count, "engine errors", &"is_engine_error", msg)


## push_error was called with a message that contains [param text], in any letter case.
func assert_push_error(text: String, msg: String = "") -> void:
	_assert_text(text, "push_error", &"is_push_error", msg)


## push_error was called exactly that many times.
func assert_push_error_count(count: int, msg: String = "") -> void:
	_assert_count(count, "push_errors", &"is_push_error", msg)


## push_warning was called with a message that contains [param text], in any letter case.
func assert_push_warning(text: String, msg: String = "") -> void:
	_assert_text(text, "push_warning", &"is_push_warning", msg)


## push_warning was called exactly that many times.
func assert_push_warning_count(count: int, msg: String = "") -> void:
	_assert_count(count, "push_warnings", &"is_push_warning", msg)


func _assert_text(text: String, kind: String, check: StringName, msg: String) -> void:
	for error: GutTrackedError in gut.error_log.peek():
		if not error.handled and error.call(check) and error.contains_text(text):
			error.handled = true
			_pass(msg)
			return
	_fail("expected a %s containing %s%s" % [kind, Text.show(text), _worded(msg)])


func _assert_count(count: int, kind: String, check: StringName, msg: String) -> void:
	var found: int = 0
	for error: GutTrackedError in gut.error_log.peek():
		if error.call(check):
			found += 1
			error.handled = error.handled or found <= count
	_expect(found == count, "expected %d %s, got %d%s" % [count, kind, found, _worded(msg)])
