extends GutTest
## One-way shapes hold what came from their free side, and let everything else pass.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Tiles := preload("res://tests/support/tiles.gd")

const FORCE := 2.0
const DEPTH := FORCE / 15000.0

var _world: HapticWorld2D
var _tool: HapticTool2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _make_platform(body: CollisionObject2D) -> CollisionObject2D:
	body.name = "Platform"
	body.position.y = 70.0
	var holder := Scene.make_box(Vector2(480, 40))
	holder.one_way_collision = true
	body.add_child(holder)
	return body


func _run(nodes: Array[Node], start: Vector2) -> void:
	_tool = Scene.make_tool(start)
	var all: Array[Node] = [_world, _tool]
	add_child_autofree(Scene.gather(all + nodes))


func _press_down(nodes: Array[Node]) -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_run(nodes, Vector2.ZERO)
	await wait_physics_frames(110)
	assert_almost_eq(_world.get_force(), Vector2(0, -FORCE), Vector2(0.02, 0.02))
	assert_almost_eq(_world.get_penetration(), DEPTH, 0.01 * DEPTH)
	assert_eq(_world.get_contacts().size(), 1)


func test_what_comes_from_its_top_is_held(
	kind: String = use_parameters(["static", "animatable", "tiles"])
) -> void:
	if kind == "tiles":
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 1), Tiles.ONE_WAY)
		layer.position.y = 50.0
		await _press_down([layer])
	elif kind == "static":
		await _press_down([_make_platform(StaticBody2D.new())])
	else:
		await _press_down([_make_platform(AnimatableBody2D.new())])


# up from below within half a second, a rest above it or inside of it, and down again
func _go_up_and_down(platform: Node, highest: float) -> void:
	_world = Scene.make_world()
	_world.record_seconds = 3.0
	(_world.device as HapticSimulatedPantograph).hand = (
		Scene
		. make_path(
			[
				[0.0, 0.0, 0.0, 0.0],
				[0.5, 0.0, 0.0, 0.0],
				[1.0, 0.0, highest, 0.0],
				[1.3, 0.0, highest, 0.0],
				[1.8, 0.0, 0.0, 0.0],
			]
		)
	)
	_run([platform], Vector2(0, 160))


func test_what_comes_from_below_passes_and_is_held_when_it_comes_back() -> void:
	# 160 px lie 40 mm below; the platform's top is at 50 px, its bottom at 90 px, the tool 40 px half
	_go_up_and_down(_make_platform(StaticBody2D.new()), -0.045)
	watch_signals(_tool)
	await wait_physics_frames(66)
	assert_signal_emit_count(_tool, "contact_began", 0)
	assert_lt(_tool.position.y, 0.0)
	await wait_physics_frames(60)
	assert_signal_emitted(_tool, "contact_began")
	# the hand pulls it far below the top, the platform holds it
	assert_between(_tool.position.y, 9.0, 20.0)
	assert_lt(_world.get_contact_force().y, -1.0)


func test_what_turns_back_inside_of_it_falls_through() -> void:
	_go_up_and_down(_make_platform(StaticBody2D.new()), -0.025)
	watch_signals(_tool)
	await wait_physics_frames(126)
	assert_signal_emit_count(_tool, "contact_began", 0)
	assert_almost_eq(_tool.position.y, 160.0, 4.0)


func test_a_platform_that_is_upside_down_holds_from_below() -> void:
	_world = Scene.make_world(Vector2(0, -FORCE), 0.3)
	var platform := _make_platform(StaticBody2D.new())
	platform.rotation = PI
	platform.position.y = -70.0
	_run([platform], Vector2.ZERO)
	await wait_physics_frames(110)
	assert_almost_eq(_world.get_force(), Vector2(0, FORCE), Vector2(0.02, 0.02))


func test_the_other_side_of_a_platform_lets_pass() -> void:
	_world = Scene.make_world(Vector2(0, -FORCE), 0.3)
	_run([_make_platform(StaticBody2D.new())], Vector2(0, 160))
	watch_signals(_tool)
	# before the hand swings back from the end of its workspace
	await wait_physics_frames(27)
	assert_lt(_tool.position.y, 0.0)
	assert_signal_emit_count(_tool, "contact_began", 0)


func test_a_platform_that_rises_carries_what_lies_on_it() -> void:
	# a new pose at every update, and the side stays
	var platform := _make_platform(AnimatableBody2D.new()) as AnimatableBody2D
	await _press_down([platform])
	for tick: int in 30:
		platform.position.y -= 0.5
		await wait_physics_frames(1)
	assert_almost_eq(_tool.position.y, platform.position.y - 60.0, 3.0)
	await wait_physics_frames(30)
	assert_almost_eq(_world.get_force(), Vector2(0, -FORCE), Vector2(0.05, 0.05))


func test_a_shape_that_becomes_one_way_while_it_is_touched_goes_on_holding() -> void:
	var platform := _make_platform(StaticBody2D.new())
	(platform.get_child(0) as CollisionShape2D).one_way_collision = false
	await _press_down([platform])
	(platform.get_child(0) as CollisionShape2D).one_way_collision = true
	await wait_physics_frames(30)
	assert_almost_eq(_world.get_force(), Vector2(0, -FORCE), Vector2(0.02, 0.02))
