extends GutTest
## Every assert on values, passing.


func test_equality() -> void:
	assert_eq(1, 1)
	assert_eq(1, 1.0)
	assert_eq("a", &"a")
	assert_eq([1, [2, 3]], [1, [2, 3]])
	assert_eq({"a": 1}, {"a": 1})
	assert_eq(Vector2(1, 2), Vector2(1, 2))
	assert_eq(null, null)
	assert_ne(1, 2, "a text")
	assert_ne([1], [2])
	assert_ne(self, null)


func test_almost() -> void:
	assert_almost_eq(1.0, 1.05, 0.1)
	assert_almost_eq(10, 12, 2)
	assert_almost_eq(Vector2(1, 2), Vector2(1.05, 1.95), Vector2(0.1, 0.1))
	assert_almost_ne(1.0, 1.2, 0.1)
	assert_almost_ne(NAN, 1.0, 0.1)


func test_order() -> void:
	assert_gt(2, 1)
	assert_gte(2, 2)
	assert_lt(1.5, 2.0)
	assert_lte(2.0, 2.0)
	assert_between(1, 1, 2)
	assert_not_between(3, 1, 2)


func test_truth_and_null() -> void:
	assert_true(true)
	assert_false(false, "a text")
	assert_null(null)
	assert_not_null(0)


func test_containers() -> void:
	assert_has([1, 2], 2)
	assert_has({"a": 1}, "a")
	assert_has(PackedInt32Array([4]), 4)
	assert_does_not_have([1, 2], 3)
	assert_eq_deep({"a": [1, {"b": 2}]}, {"a": [1, {"b": 2}]})
	assert_ne_deep([1, [2]], [1, [3]])
	var array: Array = [1]
	assert_same(array, array)
	assert_not_same(array, array.duplicate())


func test_strings() -> void:
	assert_string_contains("Hello world", "lo wo")
	assert_string_contains("Hello world", "LO WO", false)
	assert_string_starts_with("Hello", "He")
	assert_string_ends_with("Hello", "LO", false)


func test_files() -> void:
	var path: String = "user://gut_runner_self_test.txt"
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.close()
	assert_file_exists(path)
	assert_file_empty(path)
	file = FileAccess.open(path, FileAccess.WRITE)
	file.store_string("x")
	file.close()
	assert_file_not_empty(path)
	DirAccess.remove_absolute(path)
	assert_file_does_not_exist(path)


func test_types() -> void:
	var node: Node2D = autofree(Node2D.new())
	assert_is(node, Node)
	assert_is(self, GutTest)
	assert_typeof(1, TYPE_INT)
	assert_not_typeof(1, TYPE_FLOAT)
	assert_has_method(node, "get_path")
	assert_has_signal(node, "ready")


func test_passing_without_an_assert() -> void:
	pass_test("nothing to compare")
	assert_true(is_passing())
	assert_false(is_failing())


func test_with_a_parameter(value: int = use_parameters([1, 2, 3])) -> void:
	assert_between(value, 1, 3)


func test_with_arrays_as_parameter(pair: Array = use_parameters([[1, 1.0], ["a", &"a"]])) -> void:
	assert_eq(pair[0], pair[1])
	gut.p("a line of the test")
