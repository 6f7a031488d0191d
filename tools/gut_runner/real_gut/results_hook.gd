extends GutHookScript
## GUT calls this before its first test and after its last one (as pre-run and post-run script):
## it applies the filter, and writes what happened in the form that our own runner writes.

const STATUS := {"pass": "passed", "pending": "pending"}

static var _errors_before: int = 0
static var _has_begun: bool = false


func run() -> void:
	if _has_begun:
		_write()
	else:
		_begin()
	_has_begun = true


func _begin() -> void:
	printerr("[gut_runner] begin")
	_errors_before = _errors_outside().size()
	var filter: String = OS.get_environment("GUT_RUNNER_FILTER")
	if filter.is_empty():
		return
	for suite: Variant in gut.get_test_collector().scripts:
		var kept: Array = []
		for test: Variant in suite.tests:
			var names: Array = [_short(suite.path as String), suite.inner_class_name, test.name]
			if ("%s:%s:%s" % names).contains(filter):
				kept.append(test)
		suite.tests = kept


func _write() -> void:
	var suites: Array[Dictionary] = []
	for suite: Variant in gut.get_test_collector().scripts:
		if not (suite.tests as Array).is_empty():
			suites.append(_suite(suite))
	var failures: PackedStringArray = []
	for error: Variant in _errors_outside().slice(_errors_before):
		if not error.handled and not error.is_push_warning():
			failures.append("outside of any test: %s (%s)" % [error.code, error.rationale])
	var plugin: ConfigFile = ConfigFile.new()
	plugin.load("res://addons/gut/plugin.cfg")
	var results: Dictionary = {
		"runner": "GUT %s" % plugin.get_value("plugin", "version", "of an unknown version"),
		"failures": failures,
		"suites": suites,
	}
	var path: String = OS.get_environment("GUT_RUNNER_RESULTS")
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(JSON.stringify(results, "  "))
	file.close()
	printerr("[gut_runner] end")


func _suite(suite: Variant) -> Dictionary:
	var failures: PackedStringArray = []
	for around: Variant in suite.setup_teardown_tests:
		for text: String in around.fail_texts:
			failures.append("%s: %s" % [around.name, text])
	return {
		"path": _short(suite.path as String),
		"inner": str(suite.inner_class_name),
		"skipped": str(suite.skip_reason) if suite.was_skipped else "",
		"failures": failures,
		"tests": (suite.tests as Array).map(_test),
	}


func _test(test: Variant) -> Dictionary:
	var messages: Array = test.fail_texts if test.is_failing() else test.pending_texts
	var status: String = STATUS.get(test.get_status_text(), "failed")
	if test.is_failing():
		status = "failed"
	elif messages.is_empty() and status == "failed":
		messages = ["GUT says: " + test.get_status_text()]
	return {
		"name": test.name,
		"status": status,
		"asserts": test.assert_count,
		"messages": messages,
		"orphans": 0,
		"seconds": test.time_taken,
	}


## GUT keeps the errors from outside of the tests under a name of their own.
func _errors_outside() -> Array:
	return gut.error_tracker.get_errors_for_test(GutUtils.NO_TEST)


func _short(path: String) -> String:
	return path.trim_prefix("res://")
