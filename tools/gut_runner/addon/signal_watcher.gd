extends RefCounted
## Remembers every emission of every signal of the objects that a test watches.

## Object id -> signal name -> Array of argument arrays, in order of emission.
var _emissions: Dictionary[int, Dictionary] = {}
## Object id -> Array of [signal name, Callable], to undo the connections.
var _connections: Dictionary[int, Array] = {}


## Starts watching all signals of [param object]; does nothing when it is watched already.
func watch(object: Object) -> void:
	var id: int = object.get_instance_id()
	if _emissions.has(id):
		return
	_emissions[id] = {}
	_connections[id] = []
	for description: Dictionary in object.get_signal_list():
		_watch_signal(object, description["name"] as StringName)


## Whether [param object] is being watched.
func is_watching(object: Object) -> bool:
	return _emissions.has(object.get_instance_id())


## The argument arrays of every emission; empty when there was none.
func emissions(object: Object, signal_name: StringName) -> Array:
	var by_signal: Dictionary = _emissions.get(object.get_instance_id(), {})
	return by_signal.get(signal_name, [])


## Whether this signal of the object is being watched.
func knows(object: Object, signal_name: StringName) -> bool:
	var by_signal: Dictionary = _emissions.get(object.get_instance_id(), {})
	return by_signal.has(signal_name)


## The names of the signals that were emitted at least once.
func emitted_names(object: Object) -> PackedStringArray:
	var names: PackedStringArray = []
	var by_signal: Dictionary = _emissions.get(object.get_instance_id(), {})
	for signal_name: StringName in by_signal:
		if not (by_signal[signal_name] as Array).is_empty():
			names.append(signal_name)
	return names


## Stops watching everything.
func clear() -> void:
	for id: int in _connections:
		if not is_instance_id_valid(id):
			continue
		var object: Object = instance_from_id(id)
		for connection: Array in _connections[id]:
			if object.is_connected(connection[0] as StringName, connection[1] as Callable):
				object.disconnect(connection[0] as StringName, connection[1] as Callable)
	_connections.clear()
	_emissions.clear()


func _watch_signal(object: Object, signal_name: StringName) -> void:
	var id: int = object.get_instance_id()
	var log_of_signal: Array = []
	_emissions[id][signal_name] = log_of_signal
	var listener: Callable = func(...arguments: Array) -> void: log_of_signal.append(arguments)
	object.connect(signal_name, listener)
	_connections[id].append([signal_name, listener])
