# gdlint: disable=max-public-methods
extends GutTest
## Every assert, failing: not one of these tests may pass.

signal plain
signal carrying(number: int)


func test_eq() -> void:
	assert_eq(1, 2)


func test_eq_types() -> void:
	assert_eq(1, "1")


func test_eq_arrays() -> void:
	assert_eq([1, 2], [1, 3])


func test_eq_dictionaries() -> void:
	assert_eq({"a": 1}, {"a": 2})


func test_ne() -> void:
	assert_ne(1, 1.0)


func test_almost_eq() -> void:
	assert_almost_eq(1.0, 1.2, 0.1)


func test_almost_eq_nan() -> void:
	assert_almost_eq(NAN, 1.0, 0.1)


func test_almost_eq_vector() -> void:
	assert_almost_eq(Vector2(1, 2), Vector2(1, 2.2), Vector2(0.1, 0.1))


func test_almost_ne() -> void:
	assert_almost_ne(1.0, 1.05, 0.1)


func test_gt() -> void:
	assert_gt(1, 1)


func test_gte() -> void:
	assert_gte(1, 2)


func test_lt() -> void:
	assert_lt(1, 1)


func test_lte() -> void:
	assert_lte(2, 1)


func test_lt_types() -> void:
	assert_lt(1, "2")


func test_between() -> void:
	assert_between(3, 1, 2)


func test_between_no_range() -> void:
	assert_between(1, 2, 1)


func test_not_between() -> void:
	assert_not_between(1.5, 1.0, 2.0)


func test_true() -> void:
	assert_true(false)


func test_true_is_no_number() -> void:
	assert_true(1)


func test_false() -> void:
	assert_false(true)


func test_false_is_not_null() -> void:
	assert_false(null)


func test_null() -> void:
	assert_null(0)


func test_not_null() -> void:
	assert_not_null(null)


func test_has() -> void:
	assert_has([1], 2)


func test_does_not_have() -> void:
	assert_does_not_have([1], 1)


func test_eq_deep() -> void:
	assert_eq_deep([1, [2]], [1, [3]])


func test_eq_deep_size() -> void:
	assert_eq_deep([1], [1, 2])


func test_eq_deep_keys() -> void:
	assert_eq_deep({"a": 1}, {"b": 1})


func test_ne_deep() -> void:
	assert_ne_deep([1, [2]], [1, [2]])


func test_same() -> void:
	assert_same([1], [1])


func test_not_same() -> void:
	assert_not_same(self, self)


func test_string_contains() -> void:
	assert_string_contains("Hello", "HELL")


func test_string_contains_empty() -> void:
	assert_string_contains("Hello", "")


func test_string_starts_with() -> void:
	assert_string_starts_with("Hello", "lo")


func test_string_ends_with() -> void:
	assert_string_ends_with("Hello", "He")


func test_file_exists() -> void:
	assert_file_exists("res://none.txt")


func test_file_does_not_exist() -> void:
	assert_file_does_not_exist("res://project.godot")


func test_file_empty() -> void:
	assert_file_empty("res://project.godot")


func test_is() -> void:
	assert_is(self, Node2D)


func test_is_no_class() -> void:
	assert_is(self, "Node")


func test_is_no_object() -> void:
	assert_is(1, Node)


func test_typeof() -> void:
	assert_typeof(1, TYPE_FLOAT)


func test_not_typeof() -> void:
	assert_not_typeof(1, TYPE_INT)


func test_has_method() -> void:
	assert_has_method(self, "no_such_method")


func test_has_signal() -> void:
	assert_has_signal(self, "no_such_signal")


func test_freed() -> void:
	assert_freed(self)


func test_not_freed() -> void:
	assert_not_freed(null)


func test_fail_test() -> void:
	fail_test("on purpose")


func test_orphan() -> void:
	var node: Node = Node.new()
	assert_no_new_orphans()
	node.free()


func test_one_bad_among_good() -> void:
	assert_eq(1, 1)
	assert_eq(1, 2)
	assert_eq(2, 2)


func test_signal_not_watched() -> void:
	assert_signal_emitted(plain)


func test_signal_emitted() -> void:
	watch_signals(self)
	assert_signal_emitted(plain)


func test_signal_not_emitted() -> void:
	watch_signals(self)
	plain.emit()
	assert_signal_not_emitted(plain)


func test_signal_emit_count() -> void:
	watch_signals(self)
	plain.emit()
	assert_signal_emit_count(plain, 2)


func test_signal_parameters() -> void:
	watch_signals(self)
	carrying.emit(1)
	assert_signal_emitted_with_parameters(carrying, [2])


func test_signal_parameters_never_emitted() -> void:
	watch_signals(self)
	assert_signal_emitted_with_parameters(carrying, [2])


func test_connected() -> void:
	assert_connected(plain, before_all)


func test_not_connected() -> void:
	plain.connect(before_each)
	assert_not_connected(plain, before_each)


func test_wait_for_signal() -> void:
	assert_true(await wait_for_signal(plain, 0.05))


func test_wait_until() -> void:
	assert_true(await wait_until(func() -> bool: return false, 0.05))


func test_after_an_await() -> void:
	await wait_process_frames(2)
	assert_eq(1, 2)


func test_pending_does_not_hide_a_failure() -> void:
	pending("later")
	assert_eq(1, 2)


func test_one_of_the_parameters(value: int = use_parameters([1, 2, 3])) -> void:
	assert_ne(value, 2)
