extends "res://addons/gut/assert_base.gd"
## Asserts on plain values: equality, order, ranges, containers.


## Equal by value; an int may equal a float, a String a StringName.
func assert_eq(got: Variant, expected: Variant, text: String = "") -> void:
	if not _are_comparable(got, expected, text):
		return
	var message: String = "%s expected to equal %s" % [Text.show(got), Text.show(expected)]
	var is_container: bool = got is Array or got is Dictionary
	if is_container and got != expected:
		message += "\n  " + "\n  ".join(Text.differences(got, expected))
	_expect(got == expected, message + _worded(text))


## The opposite of [method assert_eq].
func assert_ne(got: Variant, not_expected: Variant, text: String = "") -> void:
	if _are_comparable(got, not_expected, text):
		var message: String = "%s expected to differ from %s"
		message = message % [Text.show(got), Text.show(not_expected)]
		_expect(got != not_expected, message + _worded(text))


## Equal to within [param error_interval], of the same type as the values; vectors by component.
func assert_almost_eq(
	got: Variant, expected: Variant, error_interval: Variant, text: String = ""
) -> void:
	if not _are_comparable(got, expected, text) or not _are_comparable(got, error_interval, text):
		return
	var message: String = (
		"%s expected to equal %s +/- %s"
		% [Text.show(got), Text.show(expected), Text.show(error_interval)]
	)
	_expect(_is_almost(got, expected, error_interval), message + _worded(text))


## The opposite of [method assert_almost_eq].
func assert_almost_ne(
	got: Variant, not_expected: Variant, error_interval: Variant, text: String = ""
) -> void:
	if not _are_comparable(got, not_expected, text):
		return
	if not _are_comparable(got, error_interval, text):
		return
	var message: String = (
		"%s expected to differ from %s by more than %s"
		% [Text.show(got), Text.show(not_expected), Text.show(error_interval)]
	)
	_expect(not _is_almost(got, not_expected, error_interval), message + _worded(text))


## Greater than.
func assert_gt(got: Variant, expected: Variant, text: String = "") -> void:
	if _are_comparable(got, expected, text):
		_expect(got > expected, _order_message(got, ">", expected, text))


## Greater than or equal.
func assert_gte(got: Variant, expected: Variant, text: String = "") -> void:
	if _are_comparable(got, expected, text):
		_expect(got >= expected, _order_message(got, ">=", expected, text))


## Less than.
func assert_lt(got: Variant, expected: Variant, text: String = "") -> void:
	if _are_comparable(got, expected, text):
		_expect(got < expected, _order_message(got, "<", expected, text))


## Less than or equal.
func assert_lte(got: Variant, expected: Variant, text: String = "") -> void:
	if _are_comparable(got, expected, text):
		_expect(got <= expected, _order_message(got, "<=", expected, text))


## In the closed range.
func assert_between(
	got: Variant, expect_low: Variant, expect_high: Variant, text: String = ""
) -> void:
	if _is_range(got, expect_low, expect_high, text):
		var message: String = "%s expected to be between %s and %s"
		message = message % [Text.show(got), Text.show(expect_low), Text.show(expect_high)]
		_expect(got >= expect_low and got <= expect_high, message + _worded(text))


## Outside of the open range.
func assert_not_between(
	got: Variant, expect_low: Variant, expect_high: Variant, text: String = ""
) -> void:
	if _is_range(got, expect_low, expect_high, text):
		var message: String = "%s expected not to be between %s and %s"
		message = message % [Text.show(got), Text.show(expect_low), Text.show(expect_high)]
		_expect(got <= expect_low or got >= expect_high, message + _worded(text))


## The boolean [code]true[/code], and nothing that merely counts as true.
func assert_true(got: Variant, text: String = "") -> void:
	_expect(got is bool and got == true, "%s expected to be true" % Text.show(got) + _worded(text))


## The boolean [code]false[/code], and nothing that merely counts as false.
func assert_false(got: Variant, text: String = "") -> void:
	var message: String = "%s expected to be false" % Text.show(got)
	_expect(got is bool and got == false, message + _worded(text))


## Null.
func assert_null(got: Variant, text: String = "") -> void:
	_expect(got == null, "%s expected to be null" % Text.show(got) + _worded(text))


## Anything but null.
func assert_not_null(got: Variant, text: String = "") -> void:
	_expect(got != null, "null expected to be something" + _worded(text))


## [param obj] (an array, a dictionary, anything with a method has) contains [param element].
func assert_has(obj: Variant, element: Variant, text: String = "") -> void:
	var message: String = "%s expected to contain %s" % [Text.show(obj), Text.show(element)]
	_expect(obj.has(element) as bool, message + _worded(text))


## The opposite of [method assert_has].
func assert_does_not_have(obj: Variant, element: Variant, text: String = "") -> void:
	var message: String = "%s expected not to contain %s" % [Text.show(obj), Text.show(element)]
	_expect(not (obj.has(element) as bool), message + _worded(text))


## Arrays or dictionaries equal at every depth; the message lists where they differ.
func assert_eq_deep(v1: Variant, v2: Variant) -> void:
	var lines: PackedStringArray = Text.differences(v1, v2)
	_expect(lines.is_empty(), "expected to be equal at every depth:\n  " + "\n  ".join(lines))


## The opposite of [method assert_eq_deep].
func assert_ne_deep(v1: Variant, v2: Variant) -> void:
	var is_different: bool = not Text.differences(v1, v2).is_empty()
	_expect(is_different, "%s expected to differ from %s" % [Text.show(v1), Text.show(v2)])


## The very same array, dictionary or object.
func assert_same(v1: Variant, v2: Variant, text: String = "") -> void:
	var message: String = "%s expected to be the same as %s" % [Text.show(v1), Text.show(v2)]
	_expect(is_same(v1, v2), message + _worded(text))


## The opposite of [method assert_same].
func assert_not_same(v1: Variant, v2: Variant, text: String = "") -> void:
	var message: String = "%s expected not to be the same as %s" % [Text.show(v1), Text.show(v2)]
	_expect(not is_same(v1, v2), message + _worded(text))


func _are_comparable(got: Variant, expected: Variant, text: String) -> bool:
	if Text.comparable(got, expected):
		return true
	var message: String = "cannot compare %s %s with %s %s"
	var got_type: String = type_string(typeof(got))
	var expected_type: String = type_string(typeof(expected))
	message = message % [got_type, Text.show(got), expected_type, Text.show(expected)]
	_fail(message + _worded(text))
	return false


func _is_almost(got: Variant, expected: Variant, interval: Variant) -> bool:
	match typeof(got):
		TYPE_INT, TYPE_FLOAT:
			return got >= expected - interval and got <= expected + interval
		TYPE_VECTOR2, TYPE_VECTOR3, TYPE_VECTOR4:
			return got.clamp(expected - interval, expected + interval) == got
	_fail("cannot tell whether %s is almost %s" % [Text.show(got), Text.show(expected)])
	return false


func _is_range(got: Variant, low: Variant, high: Variant, text: String) -> bool:
	if not _are_comparable(got, low, text) or not _are_comparable(got, high, text):
		return false
	if low > high:
		_fail("%s to %s is no range" % [Text.show(low), Text.show(high)] + _worded(text))
		return false
	return true


func _order_message(got: Variant, relation: String, expected: Variant, text: String) -> String:
	return (
		"%s expected to be %s %s" % [Text.show(got), relation, Text.show(expected)] + _worded(text)
	)
