extends GutTest
## Set-up, tear-down, freeing.

var _calls: PackedStringArray = []
var _left: Node = null


func before_all() -> void:
	_calls.append("before_all")


func before_each() -> void:
	_calls.append("before_each")


func after_each() -> void:
	_calls.append("after_each")


func after_all() -> void:
	assert_eq(_calls[_calls.size() - 1], "after_each")
	assert_false(is_instance_valid(_left), "the runner freed what autofree was given")


func test_1_before_each_ran() -> void:
	assert_eq(_calls, PackedStringArray(["before_all", "before_each"]))


func test_2_after_each_ran_too() -> void:
	assert_eq(_calls.size(), 4)
	_left = add_child_autofree(Node.new())
	assert_true(_left.is_inside_tree())
	assert_eq(_left.get_parent(), self)


func test_3_freed_when_the_test_is_over() -> void:
	assert_freed(_left)
	_left = add_child_autoqfree(Node.new())
	assert_not_freed(_left)
	assert_eq(autofree(7), 7)
	assert_no_new_orphans()


func test_4_queue_freed_when_the_test_is_over() -> void:
	assert_freed(_left, "the node")
	_left = autoqfree(Node.new())
	assert_not_null(_left)


class TestInner:
	extends GutTest

	func test_inner_class() -> void:
		assert_true(is_inside_tree())


class TestInherits:
	extends TestInner

	func test_inherits_the_tests_of_its_base() -> void:
		assert_true(has_method("test_inner_class"))


class Helper:
	extends RefCounted

	func test_is_not_a_test() -> void:
		push_error("the runner called a class that is no suite")
