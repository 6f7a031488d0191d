extends "res://addons/gut/assert_values.gd"
## Asserts on strings, files, types and objects.


## [param text] contains [param search]; both must be strings and not empty.
func assert_string_contains(text: Variant, search: Variant, match_case: bool = true) -> void:
	if _are_searchable(text, search):
		var found: bool = _folded(text, match_case).contains(_folded(search, match_case))
		_expect(found, "%s expected to contain %s" % [Text.show(text), Text.show(search)])


## [param text] starts with [param search]; both must be strings and not empty.
func assert_string_starts_with(text: Variant, search: Variant, match_case: bool = true) -> void:
	if _are_searchable(text, search):
		var found: bool = _folded(text, match_case).begins_with(_folded(search, match_case))
		_expect(found, "%s expected to start with %s" % [Text.show(text), Text.show(search)])


## [param text] ends with [param search]; both must be strings and not empty.
func assert_string_ends_with(text: Variant, search: Variant, match_case: bool = true) -> void:
	if _are_searchable(text, search):
		var found: bool = _folded(text, match_case).ends_with(_folded(search, match_case))
		_expect(found, "%s expected to end with %s" % [Text.show(text), Text.show(search)])


## The file exists.
func assert_file_exists(file_path: String) -> void:
	_expect(FileAccess.file_exists(file_path), "file %s expected to exist" % file_path)


## The file does not exist.
func assert_file_does_not_exist(file_path: String) -> void:
	_expect(not FileAccess.file_exists(file_path), "file %s expected not to exist" % file_path)


## The file exists and has no bytes.
func assert_file_empty(file_path: String) -> void:
	var is_empty: bool = FileAccess.file_exists(file_path) and _size_of(file_path) == 0
	_expect(is_empty, "file %s expected to exist and be empty" % file_path)


## The file exists and has bytes.
func assert_file_not_empty(file_path: String) -> void:
	_expect(_size_of(file_path) > 0, "file %s expected to have content" % file_path)


## The object has the method.
func assert_has_method(obj: Object, method: StringName, text: String = "") -> void:
	var message: String = "%s expected to have method %s" % [Text.show(obj), method]
	_expect(obj.has_method(method), message + _worded(text))


## [param object] is an instance of [param a_class], a class of the engine or a script.
func assert_is(object: Variant, a_class: Variant, text: String = "") -> void:
	var message: String = "%s expected to be a %s" % [Text.show(object), Text.show(a_class)]
	var names_class: bool = (
		typeof(a_class) == TYPE_OBJECT
		and (a_class is Script or (a_class as Object).get_class() == "GDScriptNativeClass")
	)
	if typeof(object) != TYPE_OBJECT or not names_class:
		_fail(message + " (needs an object and a class)" + _worded(text))
		return
	_expect(is_instance_of(object, a_class), message + _worded(text))


## [param object] is of [param type], a value of [enum Variant.Type].
func assert_typeof(object: Variant, type: int, text: String = "") -> void:
	var message: String = "%s expected to be of type %s" % [Text.show(object), type_string(type)]
	_expect(typeof(object) == type, message + _worded(text))


## The opposite of [method assert_typeof].
func assert_not_typeof(object: Variant, type: int, text: String = "") -> void:
	var message: String = "%s expected not to be of type %s"
	message = message % [Text.show(object), type_string(type)]
	_expect(typeof(object) != type, message + _worded(text))


## The object is gone.
func assert_freed(obj: Variant, title: String = "something") -> void:
	_expect(not is_instance_valid(obj), "%s expected to be freed" % title)


## The object still exists.
func assert_not_freed(obj: Variant, title: String = "something") -> void:
	_expect(is_instance_valid(obj), "%s expected not to be freed" % title)


## No node made by the test is outside of the tree now.
func assert_no_new_orphans(text: String = "") -> void:
	var orphans: PackedStringArray = gut.new_orphans()
	var message: String = "%d new orphans: %s" % [orphans.size(), ", ".join(orphans)]
	_expect(orphans.is_empty(), message + _worded(text))


func _are_searchable(text: Variant, search: Variant) -> bool:
	if text is String and search is String and not text.is_empty() and not search.is_empty():
		return true
	var message: String = "expected two strings that are not empty, got %s and %s"
	_fail(message % [Text.show(text), Text.show(search)])
	return false


func _folded(text: String, match_case: bool) -> String:
	return text if match_case else text.to_lower()


## In bytes; -1 when there is no such file.
func _size_of(file_path: String) -> int:
	var file: FileAccess = FileAccess.open(file_path, FileAccess.READ)
	return -1 if file == null else file.get_length()
