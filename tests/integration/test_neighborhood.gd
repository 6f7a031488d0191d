extends GutTest
## What the loop is told of the scene: what is near, no more, and a word when it is too much.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Tiles := preload("res://tests/support/tiles.gd")
const Reach := preload("res://addons/haptics/environment/reach.gd")

var _world: HapticWorld2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _run(nodes: Array[Node], ticks: int = 12) -> void:
	_world = Scene.make_world()
	var all: Array[Node] = [_world, Scene.make_tool(Vector2.ZERO, Vector2(40, 40))]
	add_child_autofree(Scene.gather(all + nodes))
	await wait_physics_frames(ticks)


func _figures() -> Dictionary:
	return _world.get_statistics()["neighborhood"]


func _bodies() -> Array:
	return _world.get_neighborhood().map(func(p: Dictionary) -> Node2D: return p["body"])


# walls in a circle, `distance` px away
func _make_ring(count: int, distance: float) -> Array[Node]:
	var nodes: Array[Node] = []
	for i: int in count:
		var at := Vector2(distance, 0).rotated(TAU * i / count)
		nodes.append(Scene.make_wall(at, Vector2(8, 8)))
	return nodes


func test_a_thousand_bodies_far_away_change_nothing() -> void:
	var far: Array[Node] = []
	for ring: int in 10:
		far.append_array(_make_ring(100, 2000.0 + 100.0 * ring))
	await _run(_make_ring(20, 60.0), 40)
	var alone := _figures()
	var alone_step: int = _world.get_statistics()["step_ns"]["p50"]
	_world.get_parent().queue_free()
	await wait_physics_frames(2)
	await _run(_make_ring(20, 60.0) + far, 40)
	assert_eq(_world.get_neighbor_count(), 20)
	assert_eq(_figures(), alone)
	# the same work; the bound is wide, for machines that others use too
	assert_lt(_world.get_statistics()["step_ns"]["p50"] as int, 3 * alone_step)
	# what it costs the scene is told; the bound is asked of a quiet machine (docs/environment.md)
	var tick: Dictionary = _world.get_statistics()["tick_us"]
	gut.p("a tick with 1000 bodies, 20 near: %.0f µs" % [tick["p50"] as float])
	assert_between(tick["p50"] as float, 1.0, tick["max"] as float)


func test_of_a_level_in_one_body_only_the_near_pieces_come() -> void:
	var level := StaticBody2D.new()
	for i: int in 1000:
		level.add_child(Scene.make_box(Vector2(8, 8), Vector2(10.0 * (i - 500), 60.0)))
	await _run([level])
	var reach := _world.get_reach()[0].z
	assert_eq(_figures()["bodies"], 1)
	# boxes of 8 px every 10 px that reach into the disc, 60 px below its middle
	assert_almost_eq(
		_figures()["pieces"] as float, 2.0 * sqrt(reach * reach - 56.0 * 56.0) / 10.0, 2.0
	)
	assert_eq(_figures()["left_out_pieces"], 0)


func test_of_a_thousand_tiles_only_the_near_ones_come() -> void:
	var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-50, 3, 100, 10))
	await _run([layer])
	var reach := _world.get_reach()[0].z
	var near := 0
	for cell: Vector2i in layer.get_used_cells():
		var box := Rect2(Vector2(cell * Tiles.SIZE), Vector2(Tiles.SIZE, Tiles.SIZE))
		if Vector2.ZERO.distance_to(Vector2.ZERO.clamp(box.position, box.end)) <= reach:
			near += 1
	assert_gt(near, 5)
	assert_eq(_figures()["pieces"], near)


func test_what_does_not_fit_is_said_once_counted_and_signaled() -> void:
	var nodes: Array[Node] = []
	for y: int in 15:
		for x: int in 15:
			nodes.append(Scene.make_wall(Vector2(30 + 3 * x, 30 + 3 * y), Vector2(2, 2)))
	_world = Scene.make_world()
	watch_signals(_world)
	var all: Array[Node] = [_world, Scene.make_tool(Vector2.ZERO, Vector2(40, 40))]
	add_child_autofree(Scene.gather(all + nodes))
	await wait_physics_frames(20)
	assert_push_error("The neighborhood is full: more than 128 bodies")
	assert_push_error_count(1)
	assert_signal_emit_count(_world, "neighborhood_overflowed", 1)
	assert_eq(_figures()["bodies"], 128)
	assert_eq(_figures()["left_out_bodies"], 225 - 128)
	assert_gt(_figures()["overflowed_ticks"] as int, 10)
	# the nearest are those that stay
	var bodies := _bodies()
	assert_has(bodies, nodes[0])
	assert_does_not_have(bodies, nodes[-1])


func test_what_an_object_lies_on_is_near_even_out_of_reach_of_the_tool() -> void:
	# a long plank beside the tool, and a post at its far end
	var plank := Scene.make_object(Vector2(0, 60), Vector2(1600, 20), 0.1)
	var post := Scene.make_wall(Vector2(790, 80), Vector2(10, 20))
	await _run([plank, post])
	assert_lt(_world.get_reach()[0].z, 700.0)
	assert_has(_bodies(), plank)
	assert_has(_bodies(), post)


func test_the_reach_covers_the_way_of_a_tool_under_full_acceleration() -> void:
	var reach := Reach.new()
	# 8 N on 0.25 kg from 0.4 m/s, for two ticks and the loop's latency
	var time := 2.0 / 60.0 + 0.002
	var way := 0.4 * time + 0.5 * 32.0 * time * time
	assert_almost_eq(reach.distance(0.02, 0.4, 2.0, 1.0 / 60.0), 0.02 + way + 0.01, 1e-9)


func test_the_reach_does_not_go_beyond_the_top_speed() -> void:
	var reach := Reach.new()
	# in ticks of 50 ms: 50 ms from 0.4 to 2 m/s, 1.2 m/s on average, and the rest at 2 m/s
	var way := 1.2 * 0.05 + 2.0 * (0.102 - 0.05)
	assert_almost_eq(reach.distance(0.02, 0.4, 2.0, 0.05), 0.02 + way + 0.01, 1e-9)
	# one that is faster already stays so
	assert_almost_eq(reach.distance(0.0, 3.0, 2.0, 0.05), 3.0 * 0.102 + 0.01, 1e-9)


func test_the_reach_grows_when_ticks_come_late_and_shrinks_again() -> void:
	var reach := Reach.new()
	var calm := reach.distance(0.0, 1.0, 2.0, 1.0 / 60.0)
	# three ticks in a frame of 50 ms, again and again
	for i: int in 10:
		for tick: int in 3:
			reach.note(0.05 * i + 0.0001 * tick)
	assert_gt(reach.distance(0.0, 1.0, 2.0, 1.0 / 60.0), calm + 0.03)
	for i: int in 180:
		reach.note(1.0 + i / 60.0)
	assert_almost_eq(reach.distance(0.0, 1.0, 2.0, 1.0 / 60.0), calm, 1e-6)


func test_the_picture_holds_every_piece_where_it_is() -> void:
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(200, 40))
	wall.rotation = 0.2
	await _run([wall])
	var pieces := _world.get_neighborhood()
	assert_eq(pieces.size(), 1)
	assert_same(pieces[0]["body"] as Node2D, wall)
	assert_eq(pieces[0]["kind"], "fixed")
	var corner := wall.to_global(Vector2(100, 20))
	var points: PackedVector2Array = pieces[0]["points"]
	assert_eq(points.size(), 4)
	var found := Array(points).any(func(p: Vector2) -> bool: return p.distance_to(corner) < 0.01)
	assert_true(found)
	_world.show_neighborhood = true
	await wait_physics_frames(2)
	_world.show_neighborhood = false
	await wait_physics_frames(2)
