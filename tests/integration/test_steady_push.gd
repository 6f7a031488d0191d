extends GutTest
## The paper's wall through Godot: a push of 2 N gives 2.00 N and 133 µm.

const Scene := preload("res://tests/support/haptic_scene.gd")
const FORCE := 2.0
const DEPTH := FORCE / 15000.0

var _world: HapticWorld2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _push(walls: Array[Node], force: Vector2 = Vector2(0, FORCE)) -> void:
	_world = Scene.make_world(force)
	var nodes: Array[Node] = [_world, Scene.make_tool()]
	add_child_autofree(Scene.gather(nodes + walls))
	await wait_physics_frames(210)


func _assert_steady() -> void:
	assert_true(_world.is_armed())
	assert_eq(_world.get_statistics()["force_waits_for"], "")
	assert_eq(_world.get_faults(), PackedStringArray())
	assert_almost_eq(_world.get_contact_force().length(), FORCE, 0.01 * FORCE)
	assert_almost_eq(_world.get_force().length(), FORCE, 0.01 * FORCE)
	assert_almost_eq(_world.get_penetration(), DEPTH, 0.01 * DEPTH)


func test_a_tool_that_leans_on_the_wall_from_the_start_says_what_the_force_waits_for() -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.0)
	add_child_autofree(
		Scene.gather([_world, Scene.make_tool(), Scene.make_wall(Vector2(0, 62), Vector2(480, 40))])
	)
	await wait_physics_frames(60)
	assert_false(_world.is_armed())
	assert_eq(_world.get_force(), Vector2.ZERO)
	assert_eq(_world.get_faults(), PackedStringArray())
	var figures := _world.get_statistics()
	assert_eq(figures["force_waits_for"], "Move the tool out of contact.")
	assert_string_contains(HapticRunReport.new(_world, "leaning").summary(), "out of contact")
	_world.arm(false)
	await wait_physics_frames(2)
	assert_eq(_world.get_statistics()["force_waits_for"], "Call arm().")


func test_an_edge_on_one_wall() -> void:
	await _push([Scene.make_wall(Vector2(0, 70), Vector2(480, 40))])
	_assert_steady()
	assert_almost_eq(_world.get_force(), Vector2(0, -FORCE), Vector2(0.02, 0.02))


func test_an_edge_with_an_observed_hand_and_passivity_control() -> void:
	_world = Scene.make_world(Vector2(0, FORCE))
	_world.observer = true
	_world.passivity_control = true
	add_child_autofree(
		Scene.gather([_world, Scene.make_tool(), Scene.make_wall(Vector2(0, 70), Vector2(480, 40))])
	)
	await wait_physics_frames(210)
	_assert_steady()


func test_an_edge_on_a_wall_of_four_pieces() -> void:
	var walls: Array[Node] = []
	for i: int in 4:
		walls.append(Scene.make_wall(Vector2(-180.0 + 120.0 * i, 70), Vector2(120, 40)))
	await _push(walls)
	_assert_steady()


func test_an_edge_on_one_wall_of_four_shapes() -> void:
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(120, 40))
	(wall.get_child(0) as Node2D).position.x = -180.0
	for i: int in 3:
		wall.add_child(Scene.make_box(Vector2(120, 40), Vector2(-60.0 + 120.0 * i, 0)))
	await _push([wall])
	_assert_steady()


func test_a_wall_drawn_as_an_outline() -> void:
	var wall := HapticWall2D.new()
	wall.add_child(
		Scene.make_outline(
			[
				Vector2(-240, 50),
				Vector2(240, 50),
				Vector2(240, 90),
				Vector2(20, 90),
				Vector2(0, 70),
				Vector2(-20, 90),
				Vector2(-240, 90)
			]
		)
	)
	await _push([wall])
	_assert_steady()


func test_a_wall_of_a_plain_static_body_scaled_and_turned() -> void:
	var wall := StaticBody2D.new()
	wall.add_child(Scene.make_box(Vector2(20, 240)))
	wall.scale = Vector2(2, 2)
	wall.rotation = PI / 2.0
	wall.position = Vector2(0, 70)
	await _push([wall])
	_assert_steady()


func test_a_world_boundary() -> void:
	var wall := HapticWall2D.new()
	var holder := CollisionShape2D.new()
	holder.shape = WorldBoundaryShape2D.new()
	wall.add_child(holder)
	wall.position.y = 50.0
	await _push([wall])
	_assert_steady()


func test_a_wall_to_the_right() -> void:
	await _push([Scene.make_wall(Vector2(110, 0), Vector2(40, 400))], Vector2(FORCE, 0))
	_assert_steady()
	assert_almost_eq(_world.get_force(), Vector2(-FORCE, 0), Vector2(0.02, 0.02))


func test_what_the_mask_does_not_select_is_not_felt() -> void:
	_world = Scene.make_world(Vector2(0, FORCE))
	var tool := Scene.make_tool()
	tool.collision_mask = 2
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
	add_child_autofree(Scene.gather([_world, tool, wall]))
	await wait_physics_frames(60)
	assert_eq(_world.get_contacts().size(), 0)
	assert_eq(_world.get_neighbor_count(), 0)
	assert_gt(tool.position.y, 12.0)
