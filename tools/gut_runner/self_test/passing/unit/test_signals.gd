extends GutTest
## Asserts on signals, and waits.

signal plain
signal carrying(number: int, list: Array)


func test_emission() -> void:
	watch_signals(self)
	assert_signal_not_emitted(self, "plain")
	assert_signal_not_emitted(plain)
	plain.emit()
	plain.emit()
	assert_signal_emitted(self, "plain")
	assert_signal_emitted(plain, "a text")
	assert_signal_emit_count(self, "plain", 2)
	assert_signal_emit_count(plain, 2)
	assert_eq(get_signal_emit_count(plain), 2)
	assert_eq(get_signal_emit_count(self, "plain"), 2)


func test_parameters() -> void:
	watch_signals(self)
	assert_null(get_signal_parameters(self, "carrying"))
	carrying.emit(1, [2])
	carrying.emit(3, [4])
	assert_signal_emitted_with_parameters(self, "carrying", [3, [4]])
	assert_signal_emitted_with_parameters(self, "carrying", [1, [2]], 0)
	assert_signal_emitted_with_parameters(carrying, [3, [4]])
	assert_signal_emitted_with_parameters(carrying, [1, [2]], 0)
	assert_eq(get_signal_parameters(self, "carrying"), [3, [4]])
	assert_eq(get_signal_parameters(self, "carrying", 0), [1, [2]])
	assert_eq(get_signal_parameters(carrying), [3, [4]])
	assert_eq(get_signal_parameters(carrying, 0), [1, [2]])


func test_emissions_are_forgotten_between_tests() -> void:
	watch_signals(self)
	assert_signal_not_emitted(plain)


func test_connections() -> void:
	assert_not_connected(plain, _listen)
	plain.connect(_listen)
	assert_connected(plain, _listen)
	assert_connected(plain, self)
	assert_connected(self, self, "plain")
	assert_connected(self, self, "plain", "_listen")
	plain.disconnect(_listen)
	assert_not_connected(self, self, "plain")


func test_waiting_for_frames() -> void:
	await wait_physics_frames(3)
	assert_gte(get_elapsed_physics_frames(), 3)
	assert_lte(get_elapsed_physics_frames(), 5)
	var frame: int = Engine.get_process_frames()
	await wait_process_frames(3)
	assert_between(Engine.get_process_frames() - frame, 3, 5)
	await wait_idle_frames(1)
	assert_gte(get_elapsed_process_frames(), 4)
	await wait_frames(1)


func test_waiting_for_seconds() -> void:
	var ticks: int = Engine.get_physics_frames()
	await wait_seconds(0.2)
	assert_between(Engine.get_physics_frames() - ticks, 11, 15)
	assert_gt(get_elapsed_sec(), 0.1)
	assert_gt(get_elapsed_msec(), 100)


func test_waiting_for_a_signal() -> void:
	get_tree().create_timer(0.05).timeout.connect(plain.emit)
	assert_true(await wait_for_signal(plain, 2.0))
	assert_signal_emit_count(plain, 1)
	assert_false(did_wait_timeout())
	assert_false(await wait_for_signal(carrying, 0.05))
	assert_true(did_wait_timeout())


func test_waiting_for_a_condition() -> void:
	var calls: Array[int] = [0]
	var reached: Callable = func() -> bool:
		calls[0] += 1
		return calls[0] >= 4
	assert_true(await wait_until(reached, 2.0))
	assert_false(await wait_until(func() -> bool: return false, 0.05, "a text"))
	calls[0] = 0
	assert_true(await wait_until(reached, 2.0, 0.02))
	assert_true(await wait_while(func() -> bool: return false, 1.0))
	assert_false(await wait_while(func() -> bool: return true, 0.05))


func test_simulating_frames() -> void:
	var node: Counter = add_child_autofree(Counter.new())
	node.set_process(false)
	simulate(node, 5, 0.1)
	assert_eq(node.calls, 5)
	simulate(node, 5, 0.1, true)
	assert_eq(node.calls, 5)


func _listen() -> void:
	pass


class Counter:
	extends Node
	var calls: int = 0

	func _process(_delta: float) -> void:
		calls += 1
