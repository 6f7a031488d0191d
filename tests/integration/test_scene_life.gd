extends GutTest
## Scenes live: bodies come, go, move to other parents and change while the tool touches them.
##
## HAPTICS_EDITS=10000 runs the random edits as often as the issue asks; HAPTICS_SEED=n another run.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Tiles := preload("res://tests/support/tiles.gd")

const FORCE := 2.0
const STIFFNESS := 15000.0
const USUAL_EDITS := 400

var _world: HapticWorld2D
var _tool: HapticTool2D
var _wall: HapticWall2D
var _scene: Node2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func _press(wall: Node2D = null) -> void:
	_world = Scene.make_world(Vector2(0, FORCE), 0.3)
	_tool = Scene.make_tool()
	if wall == null:
		_wall = Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
		wall = _wall
	_scene = Scene.gather([_world, _tool, wall])
	add_child_autofree(_scene)
	watch_signals(_tool)
	await wait_physics_frames(110)
	_assert_lies(STIFFNESS)


func _assert_lies(stiffness: float) -> void:
	assert_eq(_world.get_faults(), PackedStringArray())
	assert_almost_eq(_world.get_force(), Vector2(0, -FORCE), Vector2(0.02, 0.02))
	var depth := FORCE / stiffness
	assert_almost_eq(_world.get_penetration(), depth, 0.02 * depth)


func test_a_body_that_moves_to_another_parent_is_touched_without_a_break() -> void:
	await _press()
	var other := Node2D.new()
	other.position = Vector2(100, 20)
	_scene.add_child(other)
	_wall.reparent(other)
	await wait_physics_frames(10)
	_assert_lies(STIFFNESS)
	assert_signal_emit_count(_tool, "contact_ended", 0)
	assert_same(_world.get_contacts()[0].body, _wall)


func test_another_surface_counts_at_the_next_tick_also_without_a_signal() -> void:
	var wall := StaticBody2D.new()
	wall.position.y = 70.0
	wall.add_child(Scene.make_box(Vector2(480, 40)))
	await _press(wall)
	var soft := HapticSurface.new()
	soft.stiffness = 7500.0
	wall.set_meta(&"haptic_surface", soft)
	await wait_physics_frames(60)
	_assert_lies(7500.0)


func test_a_surface_that_two_walls_share_changes_for_both() -> void:
	await _press()
	var second := Scene.make_wall(Vector2(600, 70), Vector2(480, 40))
	second.surface = _wall.surface
	_scene.add_child(second)
	await wait_physics_frames(5)
	_wall.surface.stiffness = 7500.0
	await wait_physics_frames(60)
	_assert_lies(7500.0)


func test_a_shape_that_grows_shrinks_is_exchanged_and_switched_off() -> void:
	await _press()
	var holder := _wall.get_child(0) as CollisionShape2D
	# below, sideways: the top stays where it is
	(holder.shape as RectangleShape2D).size = Vector2(300, 40)
	await wait_physics_frames(30)
	_assert_lies(STIFFNESS)
	var capsule := CapsuleShape2D.new()
	capsule.radius = 20.0
	capsule.height = 200.0
	holder.rotation = PI / 2.0
	holder.shape = capsule
	await wait_physics_frames(60)
	_assert_lies(STIFFNESS)
	holder.disabled = true
	await wait_physics_frames(4)
	assert_eq(_world.get_contacts().size(), 0)


func test_tiles_that_are_dug_away_and_put_back() -> void:
	var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 3))
	layer.position.y = 50.0
	await _press(layer)
	# one beside the tool and one below the surface: nothing is felt of it
	layer.erase_cell(Vector2i(10, 0))
	layer.erase_cell(Vector2i(0, 2))
	await wait_physics_frames(20)
	_assert_lies(STIFFNESS)
	for x: int in range(-12, 24):
		layer.erase_cell(Vector2i(x, 0))
	# the next row, 20 px lower
	await wait_physics_frames(64)
	_assert_lies(STIFFNESS)
	assert_almost_eq(_tool.position.y, 30.5, 0.2)


func test_a_packed_scene_that_is_exchanged_while_it_is_touched() -> void:
	await _press()
	for child: Node in _wall.get_children():
		child.owner = _wall
	var packed := PackedScene.new()
	assert_eq(packed.pack(_wall), OK)
	for turn: int in 5:
		var next := packed.instantiate() as HapticWall2D
		_scene.add_child(next)
		_wall.queue_free()
		_wall = next
		await wait_physics_frames(20)
	await wait_physics_frames(60)
	_assert_lies(STIFFNESS)
	assert_same(_world.get_contacts()[0].body, _wall)


func test_a_rigid_body_that_is_frozen_and_thawed_while_it_is_pushed() -> void:
	var object := Scene.make_object(Vector2(0, 70), Vector2(480, 40), 0.2)
	object.freeze = true
	await _press(object)
	object.freeze = false
	await wait_physics_frames(10)
	assert_gt(object.linear_velocity.y, 1.0)
	assert_eq(_world.get_faults(), PackedStringArray())


func test_random_edits_leave_nothing_dangling() -> void:
	var edits := USUAL_EDITS
	if OS.has_environment("HAPTICS_EDITS"):
		edits = OS.get_environment("HAPTICS_EDITS").to_int()
	var random := RandomNumberGenerator.new()
	random.seed = 1
	if OS.has_environment("HAPTICS_SEED"):
		random.seed = OS.get_environment("HAPTICS_SEED").to_int()
	_world = Scene.make_world(Vector2(0, 1), 0.3)
	_tool = Scene.make_tool(Vector2.ZERO, Vector2(60, 40))
	var box := Scene.make_wall(Vector2(0, 120), Vector2(480, 40))
	_scene = Scene.gather([_world, _tool, box])
	add_child_autofree(_scene)
	var editor := SceneEdits.new(_scene, random)
	# what is touched is asked for all the time, as games do
	var pairs: Array[int] = [0, 0]
	_tool.contact_began.connect(func(_c: HapticContact) -> void: pairs[0] += 1)
	_tool.contact_ended.connect(func(_c: HapticContact) -> void: pairs[1] += 1)
	for edit: int in edits:
		editor.edit()
		if edit % 4 == 0:
			await wait_physics_frames(1)
			var contacts := _world.get_contacts()
			for contact: HapticContact in contacts:
				if not is_finite(contact.force.length()):
					fail_test("edit %d: the force is not a number" % edit)
			if not is_finite(_world.get_force().length()) or _world.get_force().length() > 30.0:
				fail_test("edit %d: the force is %s" % [edit, _world.get_force()])
	editor.free_all()
	box.free()
	await wait_physics_frames(6)
	assert_true(_world.is_running())
	assert_eq(_world.get_contacts().size(), 0)
	assert_eq(_world.get_neighbor_count(), 0)
	assert_eq(pairs[0], pairs[1])
	assert_gt(pairs[0], 0)
	print("%d edits, %d contacts" % [edits, pairs[0]])


class SceneEdits:
	## Random changes of a scene, near the tool.

	var _scene: Node2D
	var _random: RandomNumberGenerator
	var _bodies: Array[CollisionObject2D] = []
	var _parents: Array[Node2D] = []
	var _surfaces: Array[HapticSurface] = []
	var _layer: TileMapLayer

	func _init(scene: Node2D, random: RandomNumberGenerator) -> void:
		_scene = scene
		_random = random
		for i: int in 3:
			var parent := Node2D.new()
			parent.position = Vector2(10, 5) * i
			_scene.add_child(parent)
			_parents.append(parent)
			var surface := HapticSurface.new()
			surface.stiffness = 3000.0 + 4000.0 * i
			_surfaces.append(surface)
		_layer = Tiles.make_layer(Tiles.make_set(_surfaces[0]), Rect2i(-6, 6, 12, 1))
		_scene.add_child(_layer)

	func edit() -> void:
		var body := _pick()
		match _random.randi_range(0, 13) if body != null else 0:
			0, 1:
				if _bodies.size() < 12:
					_add()
			2:
				_bodies.erase(body)
				body.free()
			3:
				_bodies.erase(body)
				body.queue_free()
			4:
				body.reparent(_parents[_random.randi_range(0, 2)])
			5:
				body.position += _at(10.0)
			6:
				body.rotation += _random.randf_range(-0.3, 0.3)
			7:
				_holder(body).shape = _shape()
			8:
				_holder(body).disabled = not _holder(body).disabled
			9:
				body.collision_layer = _random.randi_range(0, 1)
			10:
				body.set_meta(&"haptic_surface", _surfaces[_random.randi_range(0, 2)])
			11:
				_surfaces[_random.randi_range(0, 2)].stiffness = _random.randf_range(
					1000.0, 15000.0
				)
			12:
				_holder(body).one_way_collision = not _holder(body).one_way_collision
			13:
				var cell := Vector2i(_random.randi_range(-6, 6), _random.randi_range(5, 7))
				_layer.set_cell(cell, 0 if _random.randf() < 0.5 else -1, Tiles.WHOLE)

	func free_all() -> void:
		for body: CollisionObject2D in _bodies:
			body.free()
		_bodies.clear()
		_layer.free()

	func _pick() -> CollisionObject2D:
		return (
			_bodies[_random.randi_range(0, _bodies.size() - 1)] if not _bodies.is_empty() else null
		)

	func _holder(body: CollisionObject2D) -> CollisionShape2D:
		return body.get_child(0) as CollisionShape2D

	func _at(spread: float) -> Vector2:
		return Vector2(_random.randf_range(-spread, spread), _random.randf_range(-spread, spread))

	func _shape() -> Shape2D:
		if _random.randf() < 0.5:
			var circle := CircleShape2D.new()
			circle.radius = _random.randf_range(5.0, 25.0)
			return circle
		var box := RectangleShape2D.new()
		box.size = Vector2(_random.randf_range(5.0, 60.0), _random.randf_range(5.0, 30.0))
		return box

	func _add() -> void:
		var body: CollisionObject2D
		match _random.randi_range(0, 2):
			0:
				body = StaticBody2D.new()
			1:
				body = AnimatableBody2D.new()
			2:
				body = CharacterBody2D.new()
		var holder := CollisionShape2D.new()
		holder.shape = _shape()
		body.add_child(holder)
		body.position = Vector2(0, 40) + _at(60.0)
		_parents[_random.randi_range(0, 2)].add_child(body)
		_bodies.append(body)
