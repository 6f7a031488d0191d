extends GutTest
## The table of docs/environment.md, a test for every row: whatever collides in Godot can be
## touched.
##
## Everywhere the hand presses a box of 160 x 80 px down with 2 N, onto something whose top lies 10
## px below it.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Tiles := preload("res://tests/support/tiles.gd")

const FORCE := 2.0
const STIFFNESS := 15000.0
const TOP := 50.0
const SETTLED := 110


## A script that is not ours, with a surface.
class Ice:
	extends StaticBody2D
	var haptic_surface: HapticSurface


class Presses:
	extends GutTest

	var world: HapticWorld2D
	var tool: HapticTool2D

	func before_all() -> void:
		Scene.hurry()

	func after_all() -> void:
		Scene.calm_down()

	func press(nodes: Array[Node]) -> void:
		world = Scene.make_world(Vector2(0, FORCE), 0.3)
		tool = Scene.make_tool()
		var all: Array[Node] = [world, tool]
		add_child_autofree(Scene.gather(all + nodes))
		await wait_physics_frames(SETTLED)

	# the tool lies still on `body`, as deep as its stiffness says
	func assert_lies_on(body: Node2D, stiffness: float = STIFFNESS) -> void:
		assert_eq(world.get_faults(), PackedStringArray())
		var contacts := world.get_contacts()
		assert_eq(contacts.size(), 1)
		if not contacts.is_empty():
			assert_same(contacts[0].body, body)
			assert_almost_eq(contacts[0].normal, Vector2(0, -1), Vector2(0.001, 0.001))
		assert_almost_eq(world.get_force(), Vector2(0, -FORCE), Vector2(0.02, 0.02))
		var depth := FORCE / stiffness
		assert_almost_eq(world.get_penetration(), depth, 0.01 * depth)
		# where it was drawn: a pixel is 250 µm
		assert_almost_eq(tool.position.y, TOP - 40.0 + 4000.0 * depth, 0.05)

	func assert_felt_nothing() -> void:
		assert_eq(world.get_contacts().size(), 0)
		assert_gt(tool.position.y, TOP - 30.0)

	func make_body(body: CollisionObject2D, holder: Node2D, at: Vector2) -> CollisionObject2D:
		body.name = "Body"
		body.position = at
		body.add_child(holder)
		return body

	func make_holder(shape: Shape2D) -> CollisionShape2D:
		var holder := CollisionShape2D.new()
		holder.name = "Shape"
		holder.shape = shape
		return holder


class TestBodies:
	extends Presses

	func _assert_is_a_wall(body: CollisionObject2D) -> void:
		make_body(body, Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0))
		await press([body])
		assert_lies_on(body)

	func test_static_body() -> void:
		await _assert_is_a_wall(StaticBody2D.new())

	func test_haptic_wall() -> void:
		await _assert_is_a_wall(HapticWall2D.new())

	func test_animatable_body() -> void:
		await _assert_is_a_wall(AnimatableBody2D.new())

	func test_character_body() -> void:
		await _assert_is_a_wall(CharacterBody2D.new())

	func test_rigid_body_that_is_frozen(
		mode: RigidBody2D.FreezeMode = use_parameters(
			[RigidBody2D.FREEZE_MODE_STATIC, RigidBody2D.FREEZE_MODE_KINEMATIC]
		)
	) -> void:
		var body := RigidBody2D.new()
		body.freeze = true
		body.freeze_mode = mode
		await _assert_is_a_wall(body)

	func test_rigid_body() -> void:
		var body := RigidBody2D.new()
		body.mass = 0.2
		body.gravity_scale = 0.0
		body.linear_damp_mode = RigidBody2D.DAMP_MODE_REPLACE
		make_body(body, Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0))
		await press([body])
		# the hand has 0.15 kg of pantograph and 0.3 kg of tool to move as well; the body flies or
		# is pushed on
		assert_gt(body.linear_velocity.y / world.pixels_per_meter, 0.2)
		assert_gte(body.position.y - tool.position.y, 59.5)

	func test_haptic_object() -> void:
		var object := Scene.make_object(Vector2(0, TOP + 20.0), Vector2(480, 40), 0.2)
		await press([object])
		assert_gt(object.linear_velocity.y / world.pixels_per_meter, 0.2)
		assert_gte(object.position.y - tool.position.y, 59.5)

	func test_tile_map_layer() -> void:
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 2))
		layer.position.y = TOP
		await press([layer])
		# many cells, one contact: the seams are not felt
		assert_lies_on(layer)

	func test_tile_map_layer_that_is_scaled() -> void:
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 2))
		layer.position.y = TOP
		layer.scale = Vector2(2, 3)
		await press([layer])
		assert_lies_on(layer)

	func test_half_a_tile_and_one_that_is_flipped() -> void:
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 1), Tiles.HALF)
		layer.position.y = TOP - Tiles.SIZE / 2.0
		await press([layer])
		assert_lies_on(layer)

	func test_a_tile_that_is_flipped() -> void:
		var layer := Tiles.make_layer(
			Tiles.make_set(), Rect2i(-12, 0, 24, 1), Tiles.HALF, TileSetAtlasSource.TRANSFORM_FLIP_V
		)
		layer.position.y = TOP
		await press([layer])
		assert_lies_on(layer)

	func test_a_tile_that_is_turned() -> void:
		# a quarter to the right, as the editor does it: the solid half lies to the left
		var turn := TileSetAtlasSource.TRANSFORM_TRANSPOSE | TileSetAtlasSource.TRANSFORM_FLIP_H
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(0, -12, 1, 24), Tiles.HALF, turn)
		layer.position = Vector2(0, TOP)
		# lies on its side, so that its solid half points up
		layer.rotation = PI / 2.0
		await press([layer])
		assert_lies_on(layer)

	func test_old_tile_map_is_refused_with_a_reason() -> void:
		var map := TileMap.new()
		map.name = "Old"
		map.tile_set = Tiles.make_set()
		for x: int in range(-12, 12):
			map.set_cell(0, Vector2i(x, 0), 0, Tiles.WHOLE)
		map.position.y = TOP
		await press([map])
		assert_push_error("a TileMap cannot be touched. Use TileMapLayers")
		assert_felt_nothing()


class TestShapes:
	extends Presses

	func _assert_is_touched(holder: Node2D, top: float) -> void:
		var body := make_body(StaticBody2D.new(), holder, Vector2(0, TOP - top))
		await press([body])
		assert_lies_on(body)

	func test_rectangle() -> void:
		await _assert_is_touched(Scene.make_box(Vector2(480, 40)), -20.0)

	func test_circle() -> void:
		var circle := CircleShape2D.new()
		circle.radius = 60.0
		await _assert_is_touched(make_holder(circle), -60.0)

	func test_capsule() -> void:
		var capsule := CapsuleShape2D.new()
		capsule.radius = 30.0
		capsule.height = 300.0
		var holder := make_holder(capsule)
		holder.rotation = PI / 2.0
		await _assert_is_touched(holder, -30.0)

	func test_segment() -> void:
		var segment := SegmentShape2D.new()
		segment.a = Vector2(-240, 0)
		segment.b = Vector2(240, 0)
		await _assert_is_touched(make_holder(segment), 0.0)

	func test_convex_polygon() -> void:
		var polygon := ConvexPolygonShape2D.new()
		polygon.points = [Vector2(-240, 0), Vector2(240, 0), Vector2(100, 60), Vector2(-100, 60)]
		await _assert_is_touched(make_holder(polygon), 0.0)

	func test_concave_polygon() -> void:
		var polygon := ConcavePolygonShape2D.new()
		polygon.segments = [Vector2(-240, 0), Vector2(10, 0), Vector2(10, 0), Vector2(240, 0)]
		await _assert_is_touched(make_holder(polygon), 0.0)

	func test_world_boundary() -> void:
		await _assert_is_touched(make_holder(WorldBoundaryShape2D.new()), 0.0)

	func test_separation_ray_is_refused_with_a_reason() -> void:
		var body := make_body(
			CharacterBody2D.new(), make_holder(SeparationRayShape2D.new()), Vector2(0, TOP)
		)
		await press([body])
		assert_push_error(
			"Body has no shape but SeparationRayShape2D, which has no surface to touch"
		)
		assert_felt_nothing()

	func test_separation_ray_beside_another_shape() -> void:
		var body := make_body(
			CharacterBody2D.new(), Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0)
		)
		body.add_child(make_holder(SeparationRayShape2D.new()))
		await press([body])
		assert_push_error("is a SeparationRayShape2D, which has no surface to touch")
		assert_lies_on(body)

	func test_collision_polygon(
		mode: CollisionPolygon2D.BuildMode = use_parameters(
			[CollisionPolygon2D.BUILD_SOLIDS, CollisionPolygon2D.BUILD_SEGMENTS]
		)
	) -> void:
		var outline := Scene.make_outline(
			[Vector2(-240, 0), Vector2(240, 0), Vector2(240, 80), Vector2(0, 30), Vector2(-240, 80)]
		)
		outline.build_mode = mode
		await _assert_is_touched(outline, 0.0)


class TestPlaces:
	extends Presses

	func test_a_body_that_is_scaled_and_turned() -> void:
		var body := make_body(
			StaticBody2D.new(), Scene.make_box(Vector2(20, 240)), Vector2(0, TOP + 20.0)
		)
		body.scale = Vector2(2, 2)
		body.rotation = PI / 2.0
		await press([body])
		assert_lies_on(body)

	func test_a_shape_that_is_scaled_and_turned() -> void:
		var holder := Scene.make_box(Vector2(20, 240), Vector2(7, 0))
		holder.scale = Vector2(2, 2)
		holder.rotation = PI / 2.0
		var body := make_body(StaticBody2D.new(), holder, Vector2(0, TOP + 20.0))
		await press([body])
		assert_lies_on(body)

	func test_a_body_that_is_mirrored() -> void:
		var polygon := ConvexPolygonShape2D.new()
		polygon.points = [Vector2(-240, -30), Vector2(100, -60), Vector2(240, 0), Vector2(-240, 0)]
		var body := make_body(StaticBody2D.new(), make_holder(polygon), Vector2(0, TOP))
		body.scale = Vector2(1, -1)
		await press([body])
		assert_lies_on(body)

	func test_a_body_in_the_depth_of_a_scene() -> void:
		var outer := Node2D.new()
		outer.position = Vector2(30, 100)
		outer.rotation = 0.4
		outer.scale = Vector2(2, 2)
		var inner := Node2D.new()
		inner.position = Vector2(-20, 5)
		inner.rotation = -0.1
		outer.add_child(inner)
		var body := make_body(StaticBody2D.new(), Scene.make_box(Vector2(240, 20)), Vector2.ZERO)
		inner.add_child(body)
		# level and at its place again
		body.rotation = -0.3
		body.position = (
			(outer.transform * inner.transform).affine_inverse() * Vector2(0, TOP + 20.0)
		)
		await press([outer])
		assert_lies_on(body)

	func test_a_shape_that_is_disabled() -> void:
		var body := make_body(
			StaticBody2D.new(), Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0)
		)
		(body.get_child(0) as CollisionShape2D).disabled = true
		await press([body])
		assert_felt_nothing()

	func test_a_body_on_another_layer() -> void:
		var body := make_body(
			StaticBody2D.new(), Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0)
		)
		body.collision_layer = 2
		await press([body])
		assert_felt_nothing()

	func test_tiles_on_another_layer() -> void:
		var layer := Tiles.make_layer(Tiles.make_set(null, 2), Rect2i(-12, 0, 24, 2))
		layer.position.y = TOP
		await press([layer])
		assert_felt_nothing()


class TestSurfaces:
	extends Presses

	func _make_soft() -> HapticSurface:
		var soft := HapticSurface.new()
		soft.stiffness = 5000.0
		return soft

	func _make_floor(body: CollisionObject2D) -> CollisionObject2D:
		return make_body(body, Scene.make_box(Vector2(480, 40)), Vector2(0, TOP + 20.0))

	func test_the_property_of_our_nodes() -> void:
		var wall := HapticWall2D.new()
		wall.surface = _make_soft()
		wall.set_meta(&"haptic_surface", HapticSurface.new())
		await press([_make_floor(wall)])
		assert_lies_on(wall, 5000.0)

	func test_a_property_haptic_surface_of_any_script() -> void:
		var ice := Ice.new()
		ice.haptic_surface = _make_soft()
		await press([_make_floor(ice)])
		assert_lies_on(ice, 5000.0)

	func test_metadata() -> void:
		var body := StaticBody2D.new()
		body.set_meta(&"haptic_surface", _make_soft())
		await press([_make_floor(body)])
		assert_lies_on(body, 5000.0)

	func test_the_custom_data_layer_of_tiles() -> void:
		var layer := Tiles.make_layer(
			Tiles.make_set(_make_soft()), Rect2i(-12, 0, 24, 1), Tiles.OWN_SURFACE
		)
		layer.position.y = TOP
		await press([layer])
		assert_lies_on(layer, 5000.0)

	func test_metadata_of_a_tile_map_layer() -> void:
		var layer := Tiles.make_layer(Tiles.make_set(), Rect2i(-12, 0, 24, 1))
		layer.position.y = TOP
		layer.set_meta(&"haptic_surface", _make_soft())
		await press([layer])
		assert_lies_on(layer, 5000.0)

	func test_the_default_of_the_world() -> void:
		var body := _make_floor(StaticBody2D.new())
		world = Scene.make_world(Vector2(0, FORCE), 0.3)
		world.default_surface = _make_soft()
		tool = Scene.make_tool()
		add_child_autofree(Scene.gather([world, tool, body]))
		await wait_physics_frames(SETTLED)
		assert_lies_on(body, 5000.0)
