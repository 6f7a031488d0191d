extends GutTest
## What a touched body is made of changes, piece by piece: what stays is not felt, what goes or
## comes fades.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Rows := preload("res://tests/support/run_rows.gd")
const Tiles := preload("res://tests/support/tiles.gd")

# when the hand rests, s
const RESTS := 1.0

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# a hand on a spring leans `depth` m into `body`, whose top lies 10 px below the tool
func _lean(body: Node2D, depth: float) -> void:
	_world = Scene.make_world()
	_world.record_seconds = 4.0
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.3, 0.0, 0.0, 0.0], [0.7, 0.0, depth, 0.0]]
	)
	_tool = Scene.make_tool()
	add_child_autofree(Scene.gather([_world, _tool, body]))
	watch_signals(_tool)
	while _world.get_state().is_empty() or _world.get_state()[1] < RESTS:
		await wait_physics_frames(1)


func _largest_change() -> float:
	var rows: Rows = Rows.of(_world)
	return rows.largest_change(RESTS, 10.0)


# a U whose floor carries the tool
func _u(first: int, rim: float = 0.0) -> PackedVector2Array:
	var corners: PackedVector2Array = [
		Vector2(-240, -60),
		Vector2(-200, -60),
		Vector2(-200, 0),
		Vector2(200, 0),
		Vector2(200, -60 - rim),
		Vector2(240, -60 - rim),
		Vector2(240, 40),
		Vector2(-240, 40)
	]
	return corners.slice(first) + corners.slice(0, first)


func test_an_outline_that_is_drawn_anew_at_every_tick_is_not_felt() -> void:
	var body := StaticBody2D.new()
	body.position.y = 50.0
	var outline := Scene.make_outline(_u(0))
	body.add_child(outline)
	await _lean(body, 0.006)
	assert_gt(_world.get_force().length(), 2.0)
	for tick: int in 60:
		# the same corners beginning with another one, the other way round, a rim that grows, edges alone
		outline.polygon = _u(tick % 8, tick)
		if tick % 3 == 0:
			var corners := outline.polygon
			corners.reverse()
			outline.polygon = corners
		if tick % 10 == 0:
			outline.build_mode = ((tick & 2) >> 1) as CollisionPolygon2D.BuildMode
		await wait_physics_frames(1)
	assert_lt(_largest_change(), 0.002)
	assert_signal_emit_count(_tool, "contact_began", 1)
	assert_signal_emit_count(_tool, "contact_ended", 0)
	assert_eq(_world.get_neighbor_count(), 1)


func test_tiles_that_are_dug_away_from_under_the_tool_fade() -> void:
	var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 3))
	layer.position.y = 50.0
	await _lean(layer, 0.004)
	assert_gt(_world.get_force().length(), 1.0)
	for x: int in range(-12, 12):
		layer.erase_cell(Vector2i(x, 0))
		await wait_physics_frames(1)
	await wait_physics_frames(20)
	assert_eq(_world.get_contacts().size(), 0)
	assert_lt(_largest_change(), 0.2)


func test_a_piece_of_a_body_that_goes_and_comes_fades() -> void:
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
	wall.add_child(Scene.make_box(Vector2(480, 40), Vector2(0, 20)))
	await _lean(wall, 0.004)
	var upper := wall.get_child(0) as CollisionShape2D
	var force := _world.get_force()
	assert_gt(force.length(), 1.0)
	for turn: int in 4:
		upper.disabled = turn % 2 == 0
		await wait_physics_frames(20)
	assert_almost_eq(_world.get_force(), force, Vector2(0.01, 0.01))
	# without it 1.5 mm come at once: 8 N, all that the device has
	assert_lt(_largest_change(), 0.3)
	assert_eq(_world.get_faults(), PackedStringArray())
