extends GutTest
## What a game hears and asks: who is touched, since when, how hard. All of it on the main thread.

const Scene := preload("res://tests/support/haptic_scene.gd")
const TouchSignals := preload("res://addons/haptics/nodes/touch_signals.gd")

const FORCE := 2.0

var _world: HapticWorld2D
var _tool: HapticTool2D
var _wall: HapticWall2D


## A body that is not ours and wants to know.
class Listener:
	extends StaticBody2D
	signal touch_began(tool: HapticTool2D, contact: HapticContact)
	signal touch_ended(tool: HapticTool2D, contact: HapticContact)


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _press(more: Array[Node] = []) -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool()
	_wall = Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
	var nodes: Array[Node] = [_world, _tool, _wall]
	add_child_autofree(Scene.gather(nodes + more))
	watch_signals(_tool)
	watch_signals(_wall)
	await wait_physics_frames(110)


func test_a_body_hears_that_it_is_touched_and_that_it_no_longer_is() -> void:
	await _press()
	assert_signal_emit_count(_wall, "touch_began", 1)
	var told: Array = get_signal_parameters(_wall, "touch_began", 0)
	assert_same(told[0], _tool)
	assert_same((told[1] as HapticContact).body, _wall)
	_wall.collision_layer = 0
	await wait_physics_frames(5)
	assert_signal_emit_count(_wall, "touch_ended", 1)
	assert_signal_emit_count(_tool, "contact_ended", 1)


func test_a_body_of_any_script_hears_it_when_it_has_the_signals() -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool()
	var body := Listener.new()
	body.add_child(Scene.make_box(Vector2(480, 40)))
	body.position.y = 70.0
	add_child_autofree(Scene.gather([_world, _tool, body]))
	watch_signals(body)
	await wait_physics_frames(90)
	assert_signal_emit_count(body, "touch_began", 1)


func test_force_and_depth_body_by_body() -> void:
	# two walls side by side, one of another stiffness: the box lies on both
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool()
	var left := Scene.make_wall(Vector2(-60, 70), Vector2(100, 40))
	var right := Scene.make_wall(Vector2(60, 70), Vector2(100, 40))
	var away := Scene.make_wall(Vector2(400, 70), Vector2(100, 40))
	right.surface.stiffness = 14000.0
	add_child_autofree(Scene.gather([_world, _tool, left, right, away]))
	await wait_physics_frames(110)
	assert_true(_tool.is_touching())
	assert_true(_tool.is_touching(left))
	assert_false(_tool.is_touching(away))
	assert_eq(_tool.get_touched_bodies().size(), 2)
	var sum := _tool.get_force_from(left) + _tool.get_force_from(right)
	assert_almost_eq(sum, Vector2(0, -FORCE), Vector2(0.02, 0.02))
	assert_almost_eq(_world.get_contact_force(), sum, Vector2(0.02, 0.02))
	assert_eq(_tool.get_force_from(away), Vector2.ZERO)
	# the box tilts a little: the deepest overlap is more than the mean that makes the force
	var of_left := _tool.get_force_from(left).length() / _tool.get_penetration_of(left)
	assert_between(of_left, 14500.0, 15010.0)
	var of_right := _tool.get_force_from(right).length() / _tool.get_penetration_of(right)
	assert_between(of_right, 13500.0, 14010.0)
	assert_eq(_tool.get_penetration_of(away), 0.0)


func test_what_an_object_touches_is_no_contact_of_the_tool() -> void:
	# an object that lies against a wall, untouched, near the tool
	var object := Scene.make_object(Vector2(-200, 30), Vector2(40, 40), 0.1)
	await _press([object])
	assert_eq(_tool.get_touched_bodies(), [_wall] as Array[Node2D])


func test_a_body_that_is_freed_ends_its_contact_with_null() -> void:
	await _press()
	_wall.free()
	await wait_physics_frames(6)
	assert_signal_emit_count(_tool, "contact_ended", 1)
	assert_null((get_signal_parameters(_tool, "contact_ended", 0)[0] as HapticContact).body)
	assert_eq(_tool.get_contacts().size(), 0)


func test_a_world_that_stops_ends_every_contact() -> void:
	await _press()
	_world.stop()
	assert_signal_emit_count(_tool, "contact_ended", 1)
	assert_signal_emit_count(_wall, "touch_ended", 1)
	assert_false(_tool.is_touching())


func test_handlers_may_stop_the_world_or_free_what_is_touched() -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool()
	_wall = Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
	add_child_autofree(Scene.gather([_world, _tool, _wall]))
	_tool.contact_began.connect(func(contact: HapticContact) -> void: contact.body.free())
	_tool.contact_ended.connect(func(_contact: HapticContact) -> void: _world.stop())
	await wait_physics_frames(90)
	assert_false(is_instance_valid(_wall))
	assert_false(_world.is_running())


class TestLostEvents:
	extends GutTest
	## The queue of events is bounded: what was dropped is made up for.

	var _tool: HapticTool2D
	var _body: StaticBody2D
	var _signals: TouchSignals

	func before_each() -> void:
		_tool = autofree(HapticTool2D.new())
		_body = autofree(StaticBody2D.new())
		_signals = TouchSignals.new(_tool)
		watch_signals(_tool)

	func _frame(events: Array, touched: PackedInt64Array) -> void:
		_signals.emit(events, touched, HapticUnits.new(), func(_n: int) -> Node2D: return _body)

	func _event(kind: String) -> Dictionary:
		var zero := PackedFloat64Array([0.0, 0.0])
		return {"kind": kind, "body": 7, "position": zero, "normal": zero, "time": 0.0}

	func test_a_beginning_that_was_lost_is_told() -> void:
		for frame: int in 4:
			_frame([], [7])
		assert_signal_emit_count(_tool, "contact_began", 1)

	func test_an_end_that_was_lost_is_told() -> void:
		_frame([_event("began")], [7])
		for frame: int in 4:
			_frame([], [])
		assert_signal_emit_count(_tool, "contact_began", 1)
		assert_signal_emit_count(_tool, "contact_ended", 1)

	func test_a_report_that_is_a_step_ahead_is_no_loss() -> void:
		_frame([], [7])
		_frame([_event("began")], [7])
		_frame([_event("ended"), _event("began")], [7])
		_frame([], [])
		_frame([_event("ended")], [])
		assert_signal_emit_count(_tool, "contact_began", 2)
		assert_signal_emit_count(_tool, "contact_ended", 2)
