extends RefCounted
## How values and comparisons are worded in a test's messages.


## A value as a reader wants to see it: strings quoted, objects with their class, floats in full.
static func show(value: Variant) -> String:
	match typeof(value):
		TYPE_NIL:
			return "null"
		TYPE_STRING, TYPE_STRING_NAME, TYPE_NODE_PATH:
			return '"%s"' % value
		TYPE_FLOAT:
			return String.num_scientific(value as float)
		TYPE_OBJECT:
			return _show_object(value)
	return str(value)


static func _show_object(value: Variant) -> String:
	if not is_instance_valid(value):
		return "<freed object>"
	var object: Object = value
	var script: Script = object.get_script() as Script
	if script != null and not script.resource_path.is_empty():
		return "%s(%s)" % [object, script.resource_path.get_file()]
	return str(object)


## Where arrays or dictionaries differ, one line for each place; empty when they are equal.
## Their leaves are equal as [method same_leaf] says.
static func differences(got: Variant, expected: Variant, place: String = "") -> PackedStringArray:
	if got is Array and expected is Array:
		return _array_differences(got as Array, expected as Array, place)
	if got is Dictionary and expected is Dictionary:
		return _dictionary_differences(got as Dictionary, expected as Dictionary, place)
	if same_leaf(got, expected):
		return []
	return ["%s: got %s, expected %s" % [place, show(got), show(expected)]]


## Whether two values are equal, where an int may equal a float and a String a StringName.
static func same_leaf(got: Variant, expected: Variant) -> bool:
	return comparable(got, expected) and got == expected


## Whether comparing these two types makes sense at all.
static func comparable(got: Variant, expected: Variant) -> bool:
	var types: Array[int] = [typeof(got), typeof(expected)]
	if types[0] == types[1] or types.has(TYPE_NIL):
		return true
	for family: Array in [[TYPE_INT, TYPE_FLOAT], [TYPE_STRING, TYPE_STRING_NAME]]:
		if family.has(types[0]) and family.has(types[1]):
			return true
	return false


static func _array_differences(got: Array, expected: Array, place: String) -> PackedStringArray:
	var lines: PackedStringArray = []
	if got.size() != expected.size():
		lines.append("%s: got size %d, expected %d" % [place, got.size(), expected.size()])
	for index: int in mini(got.size(), expected.size()):
		var at: String = "%s[%d]" % [place, index]
		lines.append_array(differences(got[index], expected[index], at))
	return lines


static func _dictionary_differences(
	got: Dictionary, expected: Dictionary, place: String
) -> PackedStringArray:
	var lines: PackedStringArray = []
	for key: Variant in expected:
		var at: String = "%s[%s]" % [place, show(key)]
		if got.has(key):
			lines.append_array(differences(got[key], expected[key], at))
		else:
			lines.append("%s: missing" % at)
	for key: Variant in got:
		if not expected.has(key):
			lines.append("%s[%s]: not expected" % [place, show(key)])
	return lines
