class_name GutMain
extends Node
## What a suite knows of its runner: the test that runs now, and what to do when it ends.

const ErrorLog := preload("res://addons/gut/error_log.gd")
const TestRecord := preload("res://addons/gut/test_record.gd")
const RUNNER_PATH := "res://addons/gut/"

## Every error that the engine reports.
var error_log: ErrorLog = ErrorLog.new()
## The test that runs now; before and after the tests of a suite, a record for those.
var record: TestRecord = TestRecord.new()

var _free_list: Array[Object] = []
var _queue_free_list: Array[Object] = []
var _known_orphans: Dictionary[int, bool] = {}
var _parameters: Array = []
var _parameter_count: int = 0


func _enter_tree() -> void:
	OS.add_logger(error_log)


func _exit_tree() -> void:
	OS.remove_logger(error_log)


## Prints one line under the running test.
func p(text: Variant, _level: int = 0) -> void:
	print("      ", text)


## Called by a suite's asserts.
func book_pass() -> void:
	record.passes += 1


## Called by a suite's asserts, from within the line that failed.
func book_failure(text: String) -> void:
	var prefix: String = ""
	if _parameter_count > 0:
		prefix = "params[%d] " % (_parameter_count - 1)
	record.failures.append("%s: %s%s" % [_place_of_caller(), prefix, text])


## Called by [method GutTest.pending].
func book_pending(text: String) -> void:
	record.pending_texts.append("pending" if text.is_empty() else text)


## The next of a parameterized test's values.
func next_parameter(params: Array) -> Variant:
	if _parameter_count == 0:
		_parameters = params
	_parameter_count += 1
	return _parameters[_parameter_count - 1]


## Whether the running test has had a parameter, and has more to come.
func has_more_parameters() -> bool:
	return _parameter_count > 0 and _parameter_count < _parameters.size()


## Whether the running test has had a parameter.
func has_parameters() -> bool:
	return _parameter_count > 0


## Starts booking for another test.
func begin_record(next: TestRecord) -> void:
	record = next
	_parameters = []
	_parameter_count = 0


## Remembers the nodes that are outside of the tree now, so that they count as old.
func note_orphans() -> void:
	_known_orphans.clear()
	for id: int in Node.get_orphan_node_ids():
		_known_orphans[id] = true


## Names of the nodes outside of the tree that [method note_orphans] did not see.
func new_orphans() -> PackedStringArray:
	var names: PackedStringArray = []
	for id: int in Node.get_orphan_node_ids():
		if not _known_orphans.has(id) and is_instance_id_valid(id):
			names.append(str(instance_from_id(id)))
	return names


## Has [param thing] freed when the test is over; reference counted objects free themselves.
func free_later(thing: Variant, by_queue: bool) -> void:
	if typeof(thing) != TYPE_OBJECT or thing is RefCounted:
		return
	if by_queue:
		_queue_free_list.append(thing as Object)
	else:
		_free_list.append(thing as Object)


## Frees what the test has left to be freed. Returns whether some of it takes a frame.
func free_now() -> bool:
	for thing: Variant in _free_list:
		if is_instance_valid(thing):
			(thing as Object).free()
	var takes_a_frame: bool = not _queue_free_list.is_empty()
	for thing: Variant in _queue_free_list:
		if is_instance_valid(thing):
			(thing as Node).queue_free()
	_free_list.clear()
	_queue_free_list.clear()
	return takes_a_frame


## The line of a suite (or of a helper of it) that called into the runner.
func _place_of_caller() -> String:
	for frame: Dictionary in get_stack():
		var source: String = frame["source"]
		if not source.begins_with(RUNNER_PATH):
			return "%s:%d" % [source.trim_prefix("res://"), frame["line"]]
	return "(no script line)"
