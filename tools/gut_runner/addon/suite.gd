extends RefCounted
## One class of tests: a file that extends GutTest, or a class Test… inside of such a file.

const TestRecord := preload("res://addons/gut/test_record.gd")
const BASE_PATH := "res://addons/gut/test.gd"

var path: String = ""
## The name of the class inside of the file; empty for the file itself.
var inner: String = ""
## The class itself.
var code: GDScript = null
var tests: Array[TestRecord] = []
## Why it was skipped; empty when it was not.
var skip_reason: String = ""
## What went wrong outside of its tests.
var failures: PackedStringArray = []


## The suites of a file that parsed, itself first, then its inner classes; only those with tests.
static func of_file(file_path: String, file_script: GDScript) -> Array:
	var suites: Array = [_make(file_path, "", file_script)]
	var constants: Dictionary = file_script.get_script_constant_map()
	for constant: String in constants:
		# a constant may be a number, which cannot be cast
		if not constants[constant] is GDScript:
			continue
		var inner_script: GDScript = constants[constant]
		if constant.begins_with("Test") and is_suite(inner_script):
			suites.append(_make(file_path, constant, inner_script))
	return suites.filter(func(suite: Variant) -> bool: return not suite.tests.is_empty())


## Whether the script extends GutTest.
static func is_suite(candidate: Script) -> bool:
	var base: Script = candidate.get_base_script()
	return base != null and (base.resource_path == BASE_PATH or is_suite(base))


## Drops the tests whose full name does not contain [param filter].
func keep_only(filter: String) -> void:
	if filter.is_empty():
		return
	tests = tests.filter(
		func(test: TestRecord) -> bool: return full_name(test.name).contains(filter)
	)


## "tests/unit/test_x.gd:TestInner:test_name".
func full_name(test_name: String) -> String:
	return "%s:%s:%s" % [path.trim_prefix("res://"), inner, test_name]


## "tests/unit/test_x.gd:TestInner".
func title() -> String:
	var file: String = path.trim_prefix("res://")
	return file if inner.is_empty() else "%s:%s" % [file, inner]


## All that the report needs, as plain data.
func to_dictionary() -> Dictionary:
	return {
		"path": path.trim_prefix("res://"),
		"inner": inner,
		"skipped": skip_reason,
		"failures": failures,
		"tests": tests.map(func(test: TestRecord) -> Dictionary: return test.to_dictionary()),
	}


static func _make(file_path: String, inner_name: String, suite_script: GDScript) -> Variant:
	var suite: Variant = new()
	suite.path = file_path
	suite.inner = inner_name
	suite.code = suite_script
	for method: Dictionary in suite_script.get_script_method_list():
		var name: String = method["name"]
		if name.begins_with("test_") and not suite._has_test(name):
			var record: TestRecord = TestRecord.new()
			record.name = name
			record.argument_count = (method["args"] as Array).size()
			suite.tests.append(record)
	return suite


func _has_test(name: String) -> bool:
	return tests.any(func(test: TestRecord) -> bool: return test.name == name)
