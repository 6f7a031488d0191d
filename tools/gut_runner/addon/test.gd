class_name GutTest
extends "res://addons/gut/assert_errors.gd"
## A test suite, written for the API of GUT 9.6. This is the part of that API which our suites
## need; a suite that calls anything else does not parse, and so is seen.

var _began_msec: int = 0
var _began_process_frame: int = 0
var _began_physics_frame: int = 0


## Return true, or a reason, to skip every test of this suite.
func should_skip_script() -> Variant:
	return false


## Runs once, before the first test.
func before_all() -> void:
	pass


## Runs before each test.
func before_each() -> void:
	pass


## Runs after each test.
func after_each() -> void:
	pass


## Runs once, after the last test.
func after_all() -> void:
	pass


## The default value of a test's only parameter: the test runs once for each of [param params].
func use_parameters(params: Array) -> Variant:
	return gut.next_parameter(params)


## Frees [param thing] after the test.
func autofree(thing: Variant) -> Variant:
	gut.free_later(thing, false)
	return thing


## Calls queue_free on [param thing] after the test.
func autoqfree(thing: Variant) -> Variant:
	gut.free_later(thing, true)
	return thing


## Adds [param node] to the suite and frees it after the test.
func add_child_autofree(node: Variant, legible_unique_name: bool = false) -> Variant:
	gut.free_later(node, false)
	add_child(node as Node, legible_unique_name)
	return node


## Adds [param node] to the suite and calls queue_free on it after the test.
func add_child_autoqfree(node: Variant, legible_unique_name: bool = false) -> Variant:
	gut.free_later(node, true)
	add_child(node as Node, legible_unique_name)
	return node


## Await it: waits that much scene time.
func wait_seconds(time: float, _msg: String = "") -> Variant:
	_get_waiter().start_seconds(time)
	return _waiter.finished


## Await it: waits that many physics ticks (kept by GUT for old suites).
func wait_frames(frames: int, msg: String = "") -> Variant:
	return wait_physics_frames(frames, msg)


## Await it: waits that many whole physics ticks.
func wait_physics_frames(x: int, _msg: String = "") -> Variant:
	_get_waiter().start_frames(maxi(x, 1), true)
	return _waiter.finished


## Await it: waits that many whole drawn frames.
func wait_process_frames(x: int, _msg: String = "") -> Variant:
	_get_waiter().start_frames(maxi(x, 1), false)
	return _waiter.finished


## The same as [method wait_process_frames].
func wait_idle_frames(x: int, msg: String = "") -> Variant:
	return wait_process_frames(x, msg)


## Await it: true when [param sig] was emitted within that time. Its object is watched from now on.
func wait_for_signal(sig: Signal, max_time: float, _msg: String = "") -> Variant:
	watch_signals(sig.get_object())
	_get_waiter().start_signal(sig, max_time)
	await _waiter.finished
	return not _waiter.timed_out


## Await it: true when [param callable] returned true within that time. [param p3] may be the
## seconds between two calls (default: every physics tick), else it is a message.
func wait_until(
	callable: Callable, max_time: float, p3: Variant = "", _p4: Variant = ""
) -> Variant:
	var interval: float = 0.0 if p3 is String else p3 as float
	_get_waiter().start_predicate(callable, max_time, interval, true)
	await _waiter.finished
	return not _waiter.timed_out


## Await it: true when [param callable] stopped returning true within that time.
func wait_while(
	callable: Callable, max_time: float, p3: Variant = "", _p4: Variant = ""
) -> Variant:
	var interval: float = 0.0 if p3 is String else p3 as float
	_get_waiter().start_predicate(callable, max_time, interval, false)
	await _waiter.finished
	return not _waiter.timed_out


## Whether the last wait ended because its time or its frames ran out.
func did_wait_timeout() -> bool:
	return _get_waiter().timed_out


## Calls _process and _physics_process of [param obj] and its children that many times.
func simulate(obj: Node, times: int, delta: float, check_is_processing: bool = false) -> void:
	for _time: int in times:
		if obj.has_method("_process") and (not check_is_processing or obj.is_processing()):
			obj.call("_process", delta)
		var ticks: bool = not check_is_processing or obj.is_physics_processing()
		if obj.has_method("_physics_process") and ticks:
			obj.call("_physics_process", delta)
		for child: Node in obj.get_children():
			simulate(child, 1, delta, check_is_processing)


## Restarts the clocks of the methods below; the runner does it before each test.
func reset_start_times() -> void:
	_began_msec = Time.get_ticks_msec()
	_began_process_frame = Engine.get_process_frames()
	_began_physics_frame = Engine.get_physics_frames()


## Real seconds since the test began.
func get_elapsed_sec() -> float:
	return (Time.get_ticks_msec() - _began_msec) / 1000.0


## Real milliseconds since the test began.
func get_elapsed_msec() -> int:
	return Time.get_ticks_msec() - _began_msec


## Drawn frames since the test began.
func get_elapsed_process_frames() -> int:
	return Engine.get_process_frames() - _began_process_frame


## Physics ticks since the test began.
func get_elapsed_physics_frames() -> int:
	return Engine.get_physics_frames() - _began_physics_frame
