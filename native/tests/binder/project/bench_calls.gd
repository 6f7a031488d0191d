extends SceneTree
## Prints what a call of a bound method costs from a typed script: the loop with the call less the
## empty loop, best of 5.

const COUNT: int = 1000000

var _values: PackedFloat64Array = PackedFloat64Array([1.0, 2.0, 3.0])
var _empty: float = 0.0
var _object: Node = Node.new()


func _process(_delta: float) -> bool:
	var probe: BinderProbe = BinderProbe.new()
	var counted: BinderProbeCounted = BinderProbeCounted.new()
	var untyped: Variant = probe
	_measure(
		"",
		func() -> void:
			for i: int in COUNT:
				pass
	)
	_measure(
		"void ()",
		func() -> void:
			for i: int in COUNT:
				probe.nothing()
	)
	_measure(
		"int (int)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_int(i)
	)
	_measure(
		"float (float)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_float(0.5)
	)
	_measure(
		"Vector2 (Vector2)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_vector2(Vector2.ONE)
	)
	_measure(
		"float (PackedFloat64Array of 3)",
		func() -> void:
			for i: int in COUNT:
				probe.sum(_values)
	)
	_measure(
		"String (String)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_string("text")
	)
	_measure(
		"Object (Object)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_object(_object)
	)
	_measure(
		"Ref (Ref)",
		func() -> void:
			for i: int in COUNT:
				probe.echo_ref(counted)
	)
	_measure(
		"int (int), by varcall",
		func() -> void:
			for i: int in COUNT:
				untyped.echo_int(i)
	)
	_measure(
		"the engine's own Object.get_instance_id()",
		func() -> void:
			for i: int in COUNT:
				probe.get_instance_id()
	)
	_measure(
		"the engine's own Object.is_class(String)",
		func() -> void:
			for i: int in COUNT:
				probe.is_class("X")
	)
	probe.free()
	_object.free()
	return true


## The first is the empty loop; it is taken off the others.
func _measure(what: String, body: Callable) -> void:
	var best: float = INF
	for i: int in 5:
		var start: int = Time.get_ticks_usec()
		body.call()
		best = minf(best, 1000.0 * (Time.get_ticks_usec() - start) / COUNT)
	if what.is_empty():
		_empty = best
	else:
		print("%6.1f ns  %s" % [best - _empty, what])
