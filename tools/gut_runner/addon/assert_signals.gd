extends "res://addons/gut/assert_things.gd"
## Asserts on signals. Most take either a Signal, or an object and the name of its signal, first.

const SignalWatcher := preload("res://addons/gut/signal_watcher.gd")

var _watcher: SignalWatcher = SignalWatcher.new()


## A signal, as an assert was given it, and the arguments after it.
class Named:
	extends RefCounted
	var object: Object = null
	var name: StringName = &""
	var others: Array = []

	func _init(p1: Variant, p2: Variant, p3: Variant = null, p4: Variant = null) -> void:
		if p1 is Signal:
			var given: Signal = p1
			object = given.get_object()
			name = given.get_name()
			others = [p2, p3]
		else:
			object = p1
			name = str(p2)
			others = [p3, p4]


## Remembers the emissions of all signals of [param object] until the test ends.
func watch_signals(object: Object) -> void:
	_watcher.watch(object)


## Forgets all emissions.
func clear_signal_watcher() -> void:
	_watcher.clear()


## How often the signal was emitted; -1 when it is not watched.
func get_signal_emit_count(p1: Variant, p2: Variant = null) -> int:
	var named: Named = Named.new(p1, p2)
	if not _watcher.knows(named.object, named.name):
		return -1
	return _watcher.emissions(named.object, named.name).size()


## The arguments of an emission, by default the last one; null when there is none.
func get_signal_parameters(p1: Variant, p2: Variant = null, p3: Variant = -1) -> Variant:
	var named: Named = Named.new(p1, -1 if p2 == null else p2, p3)
	var emissions: Array = _watcher.emissions(named.object, named.name)
	var index: int = named.others[0]
	return null if emissions.is_empty() else emissions[index]


## The signal was emitted at least once.
func assert_signal_emitted(p1: Variant, p2: Variant = "", p3: Variant = "") -> void:
	var named: Named = Named.new(p1, p2, p3)
	if _is_watched(named):
		var count: int = _watcher.emissions(named.object, named.name).size()
		var message: String = "signal %s expected to be emitted%s"
		_expect(count > 0, message % [named.name, _worded(str(named.others[0]))] + _emitted(named))


## The signal was not emitted.
func assert_signal_not_emitted(p1: Variant, p2: Variant = "", p3: Variant = "") -> void:
	var named: Named = Named.new(p1, p2, p3)
	if _is_watched(named):
		var count: int = _watcher.emissions(named.object, named.name).size()
		var message: String = "signal %s expected not to be emitted, was emitted %d times%s"
		_expect(count == 0, message % [named.name, count, _worded(str(named.others[0]))])


## The signal was emitted exactly that often: (signal, times, text) or (object, name, times, text).
func assert_signal_emit_count(p1: Variant, p2: Variant, p3: Variant = 0, p4: Variant = "") -> void:
	var named: Named = Named.new(p1, p2, p3, p4)
	if not _is_watched(named):
		return
	var count: int = _watcher.emissions(named.object, named.name).size()
	var message: String = "signal %s expected to be emitted %s times, was emitted %d times"
	var wanted: Variant = named.others[0]
	_expect(count == wanted, message % [named.name, wanted, count] + _emitted(named))


## An emission, by default the last one, carried these arguments:
## (signal, arguments, index) or (object, name, arguments, index).
func assert_signal_emitted_with_parameters(
	p1: Variant, p2: Variant, p3: Variant = -1, p4: Variant = -1
) -> void:
	var named: Named = Named.new(p1, p2, p3, p4)
	if not named.others[0] is Array:
		_fail("the expected arguments of signal %s must be an array" % named.name)
		return
	if not _is_watched(named):
		return
	var emissions: Array = _watcher.emissions(named.object, named.name)
	var index: int = named.others[1]
	if emissions.is_empty() or index >= emissions.size():
		var message: String = "signal %s expected to be emitted, was emitted %d times"
		_fail(message % [named.name, emissions.size()] + _emitted(named))
		return
	var lines: PackedStringArray = Text.differences(emissions[index], named.others[0])
	_expect(lines.is_empty(), "arguments of signal %s%s" % [named.name, ", ".join(lines)])


## The object has the signal.
func assert_has_signal(object: Object, signal_name: StringName, text: String = "") -> void:
	var message: String = "%s expected to have signal %s" % [Text.show(object), signal_name]
	_expect(object.has_signal(signal_name), message + _worded(text))


## (signal, callable), (signal, object), (object, object, signal name) or
## (object, object, signal name, method name) are connected.
func assert_connected(p1: Variant, p2: Variant, p3: Variant = null, p4: Variant = null) -> void:
	_expect(_are_connected(p1, p2, p3, p4), "%s expected to be connected to %s" % [p1, p2])


## The opposite of [method assert_connected].
func assert_not_connected(p1: Variant, p2: Variant, p3: Variant = null, p4: Variant = null) -> void:
	_expect(not _are_connected(p1, p2, p3, p4), "%s expected not to be connected to %s" % [p1, p2])


func _is_watched(named: Named) -> bool:
	if not _watcher.is_watching(named.object):
		_fail("%s is not watched: call watch_signals first" % Text.show(named.object))
		return false
	if not named.object.has_signal(named.name):
		_fail("%s has no signal %s" % [Text.show(named.object), named.name])
		return false
	return true


func _emitted(named: Named) -> String:
	var names: PackedStringArray = _watcher.emitted_names(named.object)
	return " (emitted: %s)" % ("nothing" if names.is_empty() else ", ".join(names))


func _are_connected(p1: Variant, p2: Variant, p3: Variant, p4: Variant) -> bool:
	var source: Signal = p1 if p1 is Signal else Signal(p1 as Object, str(p3))
	if p2 is Callable:
		return source.is_connected(p2 as Callable)
	if p4 != null:
		return source.is_connected(Callable(p2 as Object, str(p4)))
	for connection: Dictionary in source.get_connections():
		var target: Callable = connection["callable"]
		if target.get_object() == p2:
			return true
	return false
