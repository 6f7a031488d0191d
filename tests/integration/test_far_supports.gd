extends GutTest
## What the tool presses on rests on things that are out of the tool's reach.

const Scene := preload("res://tests/support/haptic_scene.gd")

const FORCE := 1.0

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# a rough object that weighs 0.245 N/kg, as with Godot's gravity at 4000 px/m
func _make(position: Vector2, size: Vector2) -> HapticObject2D:
	var object := Scene.make_object(position, size, 0.1)
	object.constant_force = Vector2(0, object.mass * 0.245 * 4000.0)
	object.surface.static_friction = 0.6
	object.surface.dynamic_friction = 0.5
	return object


func _press(nodes: Array[Node]) -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(40, 60))
	var all: Array[Node] = [_world, _tool]
	add_child_autofree(Scene.gather(all + nodes))
	await wait_physics_frames(70)


# of what is pressed on none moved by more than what its contacts and the engine's yield
func _assert_bears(bodies: Array[HapticObject2D], places: PackedVector2Array) -> void:
	assert_eq(_world.get_faults(), PackedStringArray())
	assert_almost_eq(_world.get_force().y, -FORCE, 0.03)
	for i: int in bodies.size():
		assert_almost_eq(bodies[i].position, places[i], Vector2(6, 3))
		assert_almost_eq(bodies[i].rotation, 0.0, 0.02)


func test_a_tower_bears_the_tool_whose_ground_is_three_boxes_out_of_reach() -> void:
	var boxes: Array[HapticObject2D] = []
	var places := PackedVector2Array()
	for i: int in 5:
		places.append(Vector2(0, 85 + 100 * i))
		boxes.append(_make(places[i], Vector2(160, 100)))
	var ground := Scene.make_wall(Vector2(0, 585), Vector2(300, 100))
	var nodes: Array[Node] = []
	nodes.append_array(boxes)
	nodes.append(ground)
	await _press(nodes)
	var reach := _world.get_reach()[0]
	assert_lt(reach.y + reach.z, 200.0)
	assert_eq(_world.get_neighbor_count(), 6)
	_assert_bears(boxes, places)


func test_a_plank_bears_the_tool_whose_far_end_lies_on_a_box_on_a_post() -> void:
	var plank := _make(Vector2(300, 45), Vector2(1000, 20))
	var box := _make(Vector2(790, 75), Vector2(20, 40))
	var post := Scene.make_wall(Vector2(790, 295), Vector2(20, 400))
	var near := Scene.make_wall(Vector2(-150, 155), Vector2(20, 200))
	await _press([plank, box, post, near])
	assert_lt(_world.get_reach()[0].z, 200.0)
	_assert_bears([plank, box], [Vector2(300, 45), Vector2(790, 75)])


# 30 balls in a row, of which the loop has room for 16
func test_what_hangs_together_without_end_fills_the_list_and_no_more() -> void:
	var nodes: Array[Node] = []
	for i: int in 30:
		nodes.append(_make(Vector2(0, 45 + 20 * i), Vector2(20, 20)))
	_world = Scene.make_world()
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(40, 60))
	var all: Array[Node] = [_world, _tool]
	add_child_autofree(Scene.gather(all + nodes))
	await wait_physics_frames(30)
	assert_eq(_world.get_neighbor_count(), 16)
	assert_eq(_world.get_faults(), PackedStringArray())
	assert_push_error_count(0)
