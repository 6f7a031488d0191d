extends SceneTree
## Calls every kind of bound member by both call paths. Prints `N passed, N failed` and quits with 1
## on a failure.

const LISTENER: GDScript = preload("res://error_listener.gd")

var _passed: int = 0
var _failed: int = 0
var _subject: String = ""
var _errors: RefCounted = LISTENER.new()


func _init() -> void:
	OS.add_logger(_errors.logger)


func _process(_delta: float) -> bool:
	for method: Dictionary in get_method_list():
		var name: String = method["name"]
		if name.begins_with("test_"):
			_subject = name
			var before: int = _passed + _failed
			call(name)
			_equal(_passed + _failed > before, true, "asserted something")
			_equal(_errors.take(), [] as Array[String], "no unexpected error")
	print("%d passed, %d failed" % [_passed, _failed])
	quit(0 if _failed == 0 and _passed > 0 else 1)
	return true


func test_scalars_survive_a_typed_call() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var truth: bool = probe.echo_bool(true)
	_equal(truth, true, "bool")
	var big: int = probe.echo_int(-9007199254740993)
	_equal(big, -9007199254740993, "int64")
	var small: int = probe.echo_int32(-2147483648)
	_equal(small, -2147483648, "int32")
	var real: float = probe.echo_float(0.1)
	_equal(real, 0.1, "double")
	var single: float = probe.echo_float32(0.5)
	_equal(single, 0.5, "float")
	var axis: BinderProbe.Axis = probe.echo_axis(BinderProbe.Y)
	_equal(axis, BinderProbe.Y, "scoped enum")
	probe.free()


func test_values_survive_a_typed_call() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var text: String = probe.echo_string("žluťoučký 🐎")
	_equal(text, "žluťoučký 🐎", "String")
	var text_by_value: String = probe.echo_string_by_value("")
	_equal(text_by_value, "", "empty String")
	var name: StringName = probe.echo_string_name(&"name")
	_equal(name, &"name", "StringName")
	var vector: Vector2 = probe.echo_vector2(Vector2(1.5, -2))
	_equal(vector, Vector2(1.5, -2), "Vector2")
	var pose: Transform2D = probe.echo_transform2d(Transform2D(0.3, Vector2(4, 5)))
	_equal(pose, Transform2D(0.3, Vector2(4, 5)), "Transform2D")
	var bytes: PackedByteArray = probe.echo_bytes(PackedByteArray([0, 255]))
	_equal(bytes, PackedByteArray([0, 255]), "bytes")
	var int32s: PackedInt32Array = probe.echo_int32s(PackedInt32Array([1, -2]))
	_equal(int32s, PackedInt32Array([1, -2]), "int32 array")
	var int64s: PackedInt64Array = probe.echo_int64s(PackedInt64Array([1 << 40]))
	_equal(int64s, PackedInt64Array([1 << 40]), "int64 array")
	var float32s: PackedFloat32Array = probe.echo_float32s(PackedFloat32Array([0.5]))
	_equal(float32s, PackedFloat32Array([0.5]), "float32 array")
	var float64s: PackedFloat64Array = probe.echo_float64s(PackedFloat64Array([0.1, 0.2]))
	_equal(float64s, PackedFloat64Array([0.1, 0.2]), "float64 array")
	var strings: PackedStringArray = probe.echo_strings(PackedStringArray(["a", "ž"]))
	_equal(strings, PackedStringArray(["a", "ž"]), "string array")
	var vectors: PackedVector2Array = probe.echo_vectors(PackedVector2Array([Vector2.ONE]))
	_equal(vectors, PackedVector2Array([Vector2.ONE]), "vector array")
	var callable: Callable = probe.echo_callable(_double)
	_equal(callable, _double, "Callable")
	probe.free()


func test_containers_and_variants_survive_a_typed_call() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var given: Dictionary = {"a": 1, 2: [3]}
	var dictionary: Dictionary = probe.echo_dictionary(given)
	_equal(is_same(dictionary, given), true, "a Dictionary is shared, not copied")
	var list: Array = [1, "two", null]
	var array: Array = probe.echo_array(list)
	_equal(is_same(array, list), true, "an Array is shared, not copied")
	for value: Variant in [null, 1, 2.5, "x", Vector2.UP, [1], {}, probe, Color.RED]:
		var back: Variant = probe.echo_variant(value)
		_equal(back, value, "Variant %s" % [value])
	probe.free()


func test_values_survive_a_call_by_name() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var values: Dictionary[String, Variant] = {
		"bool": false,
		"int": 1 << 60,
		"int32": 5,
		"float": 0.1,
		"float32": 0.25,
		"string": "ž",
		"string_name": &"n",
		"vector2": Vector2(1, 2),
		"transform2d": Transform2D.FLIP_X,
		"dictionary": {1: 2},
		"array": [1, [2]],
		"bytes": PackedByteArray([1]),
		"int32s": PackedInt32Array([2]),
		"int64s": PackedInt64Array([3]),
		"float32s": PackedFloat32Array([4]),
		"float64s": PackedFloat64Array([5]),
		"strings": PackedStringArray(["6"]),
		"vectors": PackedVector2Array([Vector2(7, 8)]),
		"variant": Color.BLUE,
		"callable": _double,
		"axis": 1,
		"object": probe,
		"probe": probe,
		"ref": BinderProbeCounted.new(),
		"any_ref": RefCounted.new(),
	}
	for key: String in values:
		_equal(probe.call("echo_" + key, values[key]), values[key], key)
	_equal(probe.call("echo_float", 3), 3.0, "an int for a float is converted")
	_equal(probe.call("echo_string_name", "text"), &"text", "text for a name is converted")
	probe.free()


func test_objects_keep_their_identity() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var node: Node = Node.new()
	_equal(probe.echo_object(node), node, "an object of the engine")
	_equal(probe.echo_object(probe), probe, "an object of ours")
	_equal(probe.echo_object(null) == null, true, "null")
	_equal(probe.echo_probe(probe), probe, "an object by its own class")
	_equal(probe.echo_ref(null) == null, true, "a null reference")
	var any: RefCounted = RefCounted.new()
	_equal(probe.echo_any_ref(any), any, "a reference of the engine")
	_equal(probe.class_name_of(node), "Node", "C++ calls a method of an engine object")
	_equal(str(probe), "<probe>", "_to_string")
	_equal(probe.get_post_initialized(), 1, "NOTIFICATION_POSTINITIALIZE comes once")
	node.free()
	probe.free()


func test_wrong_calls_by_name_are_refused() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var node: Node = Node.new()
	_equal(probe.callv("echo_int", ["text"]), null, "wrong type")
	_equal(
		_errors.take_containing("Cannot convert argument 1 from String to int"),
		true,
		"wrong type is said"
	)
	_equal(probe.callv("add", [1]), null, "too few")
	_equal(_errors.take_containing("expected 2 argument"), true, "too few is said")
	_equal(probe.callv("add", [1, 2, 3]), null, "too many")
	_equal(_errors.take_containing("expected 2 argument"), true, "too many is said")
	_equal(probe.callv("echo_probe", [node]), null, "an object of the wrong class")
	_equal(
		_errors.take_containing("Cannot convert argument 1 from Object to Object"),
		true,
		"wrong class is said"
	)
	_equal(probe.callv("echo_ref", [node]), null, "an object that is not counted")
	_errors.take()
	node.free()
	probe.free()


func test_default_arguments_fill_from_the_right() -> void:
	var probe: BinderProbe = BinderProbe.new()
	_equal(probe.defaults(1), 123, "both, typed")
	_equal(probe.defaults(1, 5.0), 153, "one, typed")
	_equal(probe.defaults(1, 5.0, "x"), 151, "none, typed")
	_equal(probe.call("defaults", 1), 123, "both, by name")
	_equal(probe.call("defaults", 1, 5.0), 153, "one, by name")
	_equal(probe.call("defaults", 1, 5, "x"), 151, "none, by name")
	_equal(probe.callv("defaults", []), null, "the first has none")
	_equal(_errors.take_containing("expected 1 argument"), true, "which is said")
	probe.free()


func test_static_and_void_methods() -> void:
	_equal(BinderProbe.add(2, 3), 5, "static")
	var probe: BinderProbe = BinderProbe.new()
	probe.nothing()
	_equal(probe.call("nothing"), null, "void gives null")
	_equal(probe.get_calls(), 2, "both ran")
	probe.free()


func test_exceptions_become_engine_errors() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var number: int = probe.throw_exception("first")
	_equal(number, 0, "a typed call gives the default")
	_equal(
		_errors.take_containing("BinderProbe::throw_exception failed: first"),
		true,
		"and says what failed"
	)
	_equal(probe.call("throw_exception", "second"), null, "a call by name gives null")
	_equal(_errors.take_containing("second"), true, "and says what failed")
	var dictionary: Dictionary = probe.throw_something()
	_equal(dictionary, {}, "a typed container is empty")
	_equal(_errors.take_containing("unknown C++ exception"), true, "anything may be thrown")
	probe.free()


func test_messages_reach_the_log_with_their_place() -> void:
	var probe: BinderProbe = BinderProbe.new()
	probe.complain("it broke")
	_equal(_errors.last_place(), "binder_probe.hpp", "file of the error")
	_equal(_errors.take(), ["it broke"] as Array[String], "error")
	probe.warn("it may break")
	_equal(_errors.take(), ["it may break"] as Array[String], "warning")
	probe.say("print_line: ", 3)
	_equal(_errors.take_message("print_line: 3"), true, "message")
	probe.free()


func test_packed_arrays_are_read_in_place_and_filled_by_pointer() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var values: PackedFloat64Array = PackedFloat64Array()
	values.resize(1000)
	values.fill(0.5)
	_equal(probe.sum(values), 500.0, "sum")
	_equal(probe.sum(PackedFloat64Array()), 0.0, "sum of nothing")
	_equal(probe.address(values), probe.address(values), "the same memory at each call")
	var same_memory: PackedFloat64Array = values
	_equal(probe.address(same_memory), probe.address(values), "shared memory is not copied")
	_equal(
		probe.ramp(3), PackedVector2Array([Vector2.ZERO, Vector2(1, -1), Vector2(2, -2)]), "ramp"
	)
	_equal(probe.ramp(0).size(), 0, "empty ramp")
	probe.free()


func test_dictionaries_made_in_cpp() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var made: Dictionary = probe.describe()
	_equal(made["name"], "probe", "text")
	_equal(made.gain, 1.5, "number, found by name")
	_equal(made["forces"], PackedFloat64Array([1.0, 2.5]), "packed")
	_equal(made["list"], [1, "two", Vector2(3, 3)], "list")
	_equal(made["same"], true, "C++ reads what it wrote")
	_equal(probe.read_back(3.7), [3, 3.7, "3.7", true, "3.7", false], "C++ converts a real")
	_equal(probe.read_back(4), [4, 4.0, "4", true, "4", true], "C++ converts an integer")
	probe.free()


func test_callables_go_both_ways() -> void:
	var probe: BinderProbe = BinderProbe.new()
	_equal(probe.call_back(_double, 4), 9, "C++ calls a script")
	_equal(probe.own_callable().call(2, 3), 5, "a script calls C++")
	probe.free()


func test_properties_have_hints_and_values() -> void:
	var probe: BinderProbe = BinderProbe.new()
	probe.gain = 12.5
	_equal(probe.gain, 12.5, "property")
	probe.set("gain", 13.0)
	_equal(probe.get("gain"), 13.0, "property by name")
	probe.mode = BinderProbe.MODE_BUSY
	_equal(probe.mode, 7, "enum property")
	var found: Dictionary = {}
	for property: Dictionary in probe.get_property_list():
		found[property["name"]] = property
	_equal(found["gain"]["hint"], PROPERTY_HINT_RANGE, "hint")
	_equal(found["gain"]["hint_string"], "0,100,0.5,suffix:N", "hint text")
	_equal(found.has("Contact"), true, "group")
	probe.free()


func test_constants_and_enumerations() -> void:
	_equal(BinderProbe.ANSWER, 42, "constant")
	_equal(
		ClassDB.class_get_enum_list("BinderProbe", true),
		PackedStringArray(["Mode", "Axis"]),
		"enumerations"
	)
	_equal(
		ClassDB.class_get_enum_constants("BinderProbe", "Axis"),
		PackedStringArray(["X", "Y"]),
		"members"
	)
	_equal(BinderProbe.MODE_BUSY, 7, "value")
	for method: Dictionary in ClassDB.class_get_method_list("BinderProbe", true):
		if method["name"] == "set_mode":
			_equal(
				method["args"][0]["class_name"],
				&"BinderProbe.Mode",
				"an argument names its enumeration"
			)
			_equal(method["args"][0]["name"], "mode", "an argument has a name")


func test_signals_carry_typed_arguments() -> void:
	var probe: BinderProbe = BinderProbe.new()
	var heard: Array = []
	probe.fired.connect(func(number: int, where: Vector2) -> void: heard.append([number, where]))
	probe.fire(3, Vector2(1, 2))
	_equal(heard, [[3, Vector2(1, 2)]], "heard")
	for description: Dictionary in ClassDB.class_get_signal_list("BinderProbe", true):
		_equal(description["args"][1]["type"], TYPE_VECTOR2, "type of the second argument")
		_equal(description["args"][1]["name"], "where", "name of the second argument")
	probe.free()


func test_references_are_counted_and_nothing_leaks() -> void:
	_equal(BinderProbe.count_counted_alive(), 0, "none before")
	var probe: BinderProbe = BinderProbe.new()
	for i: int in 100:
		var typed: BinderProbeCounted = probe.make_counted()
		var by_name: BinderProbeCounted = probe.call("make_counted")
		typed = probe.echo_ref(by_name)
		by_name = probe.call("echo_ref", typed)
		probe.keep(typed)
		if i == 0:
			_equal(by_name.get_reference_count(), 3, "two names and C++")
	_equal(BinderProbe.count_counted_alive(), 1, "the one that C++ holds")
	_equal(probe.kept_references(), 1, "held once")
	var held: BinderProbeCounted = probe.make_counted()
	_equal(held.get_reference_count(), 1, "a new object comes with one reference")
	_equal(held.label, "made in C++", "its property")
	held = null
	probe.free()
	_equal(BinderProbe.count_counted_alive(), 0, "none after")
	var any: RefCounted = RefCounted.new()
	var other: BinderProbe = BinderProbe.new()
	other.echo_any_ref(any)
	_equal(any.get_reference_count(), 1, "a foreign reference is given back")
	other.free()
	_equal(BinderProbe.count_alive(), 0, "no probe is left")


func test_the_singleton_is_registered_and_its_thread_runs() -> void:
	_equal(Engine.has_singleton("ProbeServer"), true, "registered")
	_equal(Engine.get_singleton("ProbeServer"), ProbeServer, "global name")
	_equal(ProbeServer.get_startups(), 1, "startup callback")
	_equal(ProbeServer.get_beats() > 0, true, "thread")
	_equal(
		ProbeServer.get_frames() <= Engine.get_process_frames() + 1,
		true,
		"frame callback once a frame"
	)
	_equal(ClassDB.can_instantiate("ProbeServer"), false, "scripts cannot make a second one")


func _double(a: int, b: int) -> int:
	return 2 * a + b


func _equal(got: Variant, expected: Variant, what: String) -> void:
	if typeof(got) == typeof(expected) and got == expected:
		_passed += 1
		return
	_failed += 1
	printerr("FAILED %s: %s: got %s, expected %s" % [_subject, what, got, expected])
