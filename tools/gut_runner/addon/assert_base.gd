extends Node
## The ground of a suite: the runner it belongs to, and how an assert is booked.

const Text := preload("res://addons/gut/text.gd")
const Waiter := preload("res://addons/gut/waiter.gd")

## The runner; set before the suite enters the tree.
var gut: GutMain = null

var _waiter: Waiter = null


## Marks the test as passing, unless an assert of it fails.
func pass_test(text: String) -> void:
	_pass(text)


## Fails the test.
func fail_test(text: String) -> void:
	_fail(text)


## Marks the test as not finished yet: it counts as skipped, unless an assert of it fails.
func pending(text: String = "") -> void:
	gut.book_pending(text)


## Whether the test has asserted something and nothing of it failed so far.
func is_passing() -> bool:
	return gut.record.failures.is_empty() and gut.record.passes > 0


## Whether an assert of the test failed so far.
func is_failing() -> bool:
	return not gut.record.failures.is_empty()


func _pass(_text: String) -> void:
	gut.book_pass()


func _fail(text: String) -> void:
	gut.book_failure(text)


func _expect(condition: bool, text: String) -> void:
	if condition:
		_pass(text)
	else:
		_fail(text)


## The waiter lives in the suite, so that it stops with the tree like the nodes under test.
func _get_waiter() -> Waiter:
	if _waiter == null:
		_waiter = Waiter.new()
		add_child(_waiter, false, Node.INTERNAL_MODE_BACK)
	return _waiter


func _worded(text: String) -> String:
	return "" if text.is_empty() else ": " + text
