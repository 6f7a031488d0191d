extends GutMain
## Runs suites one after the other and writes what happened as JSON for the report.
##
## Environment: GUT_RUNNER_DIRS (folders, by comma), GUT_RUNNER_FILTER (part of a test's full name),
## GUT_RUNNER_RESULTS (file to write), GUT_RUNNER_TEST_SECONDS (longest time for one test).

## Emitted when the results have been written.
signal ended

const Suite := preload("res://addons/gut/suite.gd")
## Seconds that queued frees get after a test: GUT waits as long.
const QUEUE_FREE_SECONDS := 0.1

var _suites: Array = []
var _failures: PackedStringArray = []
var _running: String = ""
var _deadline_msec: int = 0
var _test_seconds: float = 60.0


func _ready() -> void:
	get_tree().process_frame.connect(_watch_for_hang)
	_test_seconds = _from_environment("GUT_RUNNER_TEST_SECONDS", "60").to_float()


## Collects and runs everything; the process may quit when [signal ended] was emitted.
func run() -> void:
	printerr("[gut_runner] begin")
	_check_runner()
	for directory: String in _from_environment("GUT_RUNNER_DIRS", "res://tests").split(","):
		_collect(directory)
	for suite: Suite in _suites:
		await _run_suite(suite)
	await get_tree().process_frame
	_finish()


## Two classes GutTest in one project do not complain, and the wrong one would run.
func _check_runner() -> void:
	var homes: PackedStringArray = []
	for description: Dictionary in ProjectSettings.get_global_class_list():
		if description["class"] == &"GutTest":
			homes.append(str(description["path"]))
	if homes != PackedStringArray([Suite.BASE_PATH]):
		_failures.append("class GutTest should be in %s, is in %s" % [Suite.BASE_PATH, homes])
	if FileAccess.file_exists("res://addons/gut/gut_cmdln.gd"):
		_failures.append("addons/gut holds GUT and our runner at once")


func _collect(directory: String) -> void:
	for file: String in DirAccess.get_files_at(directory):
		if file.begins_with("test_") and file.ends_with(".gd"):
			_collect_file(directory.path_join(file))
	for child: String in DirAccess.get_directories_at(directory):
		if not FileAccess.file_exists(directory.path_join(child).path_join(".gdignore")):
			_collect(directory.path_join(child))


func _collect_file(path: String) -> void:
	var filter: String = _from_environment("GUT_RUNNER_FILTER", "")
	var short_path: String = path.trim_prefix("res://")
	_take_outside_errors()
	var script: GDScript = load(path) as GDScript
	var errors: PackedStringArray = ErrorLog.unexpected(error_log.take())
	if script == null or not errors.is_empty():
		_failures.append("%s does not parse:\n  %s" % [short_path, "\n  ".join(errors)])
		return
	if not Suite.is_suite(script):
		_failures.append("%s does not extend GutTest" % short_path)
		return
	var suites: Array = Suite.of_file(path, script)
	if suites.is_empty():
		_failures.append("%s has no test" % short_path)
	for suite: Suite in suites:
		suite.keep_only(filter)
		if not suite.tests.is_empty():
			_suites.append(suite)


func _run_suite(suite: Suite) -> void:
	print("\n", suite.title())
	_take_outside_errors()
	var node: GutTest = suite.code.new() as GutTest
	node.gut = self
	node.name = "Suite"
	add_child(node, true)
	suite.skip_reason = await _skip_reason(node)
	if suite.skip_reason.is_empty():
		await _run_around(suite, node.before_all, "before_all")
		for test: TestRecord in suite.tests:
			await _run_test(suite, node, test)
		await _run_around(suite, node.after_all, "after_all")
	else:
		print("  skipped: ", suite.skip_reason)
	node.clear_signal_watcher()
	node.queue_free()
	await get_tree().process_frame
	for error: String in ErrorLog.unexpected(error_log.take()):
		suite.failures.append("when the suite ended: " + error)


func _skip_reason(node: GutTest) -> String:
	var answer: Variant = node.get("skip_script")
	if answer == null:
		answer = await node.call(&"should_skip_script")
	if answer is bool:
		return "script marked to skip" if answer else ""
	return "" if answer == null else str(answer)


func _run_around(suite: Suite, method: Callable, method_name: String) -> void:
	var around: TestRecord = TestRecord.new()
	around.name = method_name
	begin_record(around)
	_start_clock(suite.full_name(method_name))
	await method.call()
	_running = ""
	for error: String in ErrorLog.unexpected(error_log.take()):
		around.failures.append(error)
	for failure: String in around.failures:
		suite.failures.append("%s: %s" % [method_name, failure])


func _run_test(suite: Suite, node: GutTest, test: TestRecord) -> void:
	begin_record(test)
	var began_usec: int = Time.get_ticks_usec()
	_start_clock(suite.full_name(test.name))
	print("  ", test.name)
	if test.argument_count > 1:
		test.failures.append(
			"a test takes one parameter at most, this takes %d" % test.argument_count
		)
	else:
		await _run_once(node, test)
		if test.argument_count == 1 and not has_parameters():
			test.failures.append("its parameter needs use_parameters(…) as default value")
		while has_more_parameters():
			await _run_once(node, test)
	_running = ""
	test.seconds = (Time.get_ticks_usec() - began_usec) * 1e-6
	if test.status() != TestRecord.PASSED:
		print("    ", test.status().to_upper(), "\n      ", "\n      ".join(_messages(test)))
	begin_record(TestRecord.new())


## One call of a test, with all that belongs before and after it. Errors of the fixtures are taken
## apart from those of the test, as GUT does: a test cannot expect what its before_each reported.
func _run_once(node: GutTest, test: TestRecord) -> void:
	var asserts_before: int = test.asserts()
	note_orphans()
	_take_outside_errors()
	await node.before_each()
	_book_errors(test, "in before_each: ")
	node.reset_start_times()
	await node.call(test.name)
	_book_errors(test, "")
	if test.asserts() == asserts_before and test.pending_texts.is_empty():
		test.failures.append("asserted nothing (use pass_test if that is meant)")
	node.clear_signal_watcher()
	await node.after_each()
	if free_now():
		await get_tree().create_timer(QUEUE_FREE_SECONDS).timeout
	await get_tree().process_frame
	_book_errors(test, "after the test: ")
	var orphans: PackedStringArray = new_orphans()
	test.orphans += orphans.size()
	if not orphans.is_empty():
		print("    note: leaves nodes outside of the tree: ", ", ".join(orphans))


func _book_errors(test: TestRecord, prefix: String) -> void:
	for error: String in ErrorLog.unexpected(error_log.take()):
		test.failures.append("unexpected error %s%s" % [prefix, error])


func _take_outside_errors() -> void:
	for error: String in ErrorLog.unexpected(error_log.take()):
		_failures.append("outside of any test: " + error)


func _start_clock(full_name: String) -> void:
	_running = full_name
	_deadline_msec = Time.get_ticks_msec() + roundi(_test_seconds * 1000.0)


## A test that awaits what never comes cannot be stopped: say so, and end the run here.
func _watch_for_hang() -> void:
	if _running.is_empty() or Time.get_ticks_msec() < _deadline_msec:
		return
	var message: String = (
		"%s did not finish in %s s; the run stops here" % [_running, _test_seconds]
	)
	_failures.append(message)
	record.failures.append(message)
	_running = ""
	_finish()


func _finish() -> void:
	_take_outside_errors()
	var results: Dictionary = {
		"runner": "ours (GUT 9.6 API)",
		"failures": _failures,
		"suites": _suites.map(func(suite: Suite) -> Dictionary: return suite.to_dictionary()),
	}
	var path: String = _from_environment("GUT_RUNNER_RESULTS", "user://results.json")
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(JSON.stringify(results, "  "))
	file.close()
	printerr("[gut_runner] end")
	ended.emit()


func _messages(test: TestRecord) -> PackedStringArray:
	return test.to_dictionary()["messages"]


func _from_environment(variable: String, default: String) -> String:
	var value: String = OS.get_environment(variable)
	return default if value.is_empty() else value
