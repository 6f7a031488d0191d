extends GutTest
## Collision shapes as the native side takes them: every kind, scaled, turned and one-way.

const ShapeReader := preload("res://addons/haptics/environment/shape_reader.gd")


func _read(shape: Shape2D, place: Transform2D = Transform2D.IDENTITY) -> ShapeReader:
	var holder := CollisionShape2D.new()
	holder.shape = shape
	holder.transform = place
	return _read_node(holder)


func _read_node(holder: Node2D) -> ShapeReader:
	var body: StaticBody2D = add_child_autofree(StaticBody2D.new())
	body.add_child(holder)
	var reader := ShapeReader.new(HapticUnits.new(100.0))
	reader.read(body, Transform2D.IDENTITY)
	return reader


func _assert_points(reader: ShapeReader, wanted: PackedFloat64Array, index: int = 0) -> void:
	var points: PackedFloat64Array = reader.shapes[index]["points"]
	assert_eq(points.size(), wanted.size())
	for i: int in mini(points.size(), wanted.size()):
		assert_almost_eq(points[i], wanted[i], 1e-7)


func test_a_rectangle_is_its_four_corners() -> void:
	var box := RectangleShape2D.new()
	box.size = Vector2(20, 10)
	var reader := _read(box, Transform2D(0.0, Vector2(100, 0)))
	assert_eq(reader.shapes[0]["kind"], "polygon")
	_assert_points(reader, [0.9, 0.05, 1.1, 0.05, 1.1, -0.05, 0.9, -0.05])


func test_a_circle_is_its_center_and_its_scaled_radius() -> void:
	var circle := CircleShape2D.new()
	circle.radius = 10.0
	var reader := _read(circle, Transform2D(0.3, Vector2(2, 2), 0.0, Vector2(50, 100)))
	assert_eq(reader.shapes[0]["kind"], "circle")
	_assert_points(reader, [0.5, -1.0])
	assert_almost_eq(reader.shapes[0]["radius"] as float, 0.2, 1e-6)


func test_a_capsule_is_two_points_and_a_radius() -> void:
	var capsule := CapsuleShape2D.new()
	capsule.radius = 10.0
	capsule.height = 60.0
	var reader := _read(capsule)
	assert_eq(reader.shapes[0]["kind"], "capsule")
	_assert_points(reader, [0.0, 0.2, 0.0, -0.2])


func test_a_segment_is_two_points() -> void:
	var segment := SegmentShape2D.new()
	segment.a = Vector2(-10, 0)
	segment.b = Vector2(10, 20)
	_assert_points(_read(segment), [-0.1, 0.0, 0.1, -0.2])


func test_a_concave_polygon_is_segments_with_numbers_of_their_own() -> void:
	var segments := ConcavePolygonShape2D.new()
	segments.segments = [Vector2(0, 0), Vector2(10, 0), Vector2(10, 0), Vector2(10, 10)]
	var reader := _read(segments)
	assert_eq(reader.shapes.size(), 2)
	assert_eq(reader.shapes[1]["kind"], "segment")
	assert_ne(reader.shapes[0]["id"], reader.shapes[1]["id"])
	_assert_points(reader, [0.1, 0.0, 0.1, -0.1], 1)


func test_a_world_boundary_is_a_point_and_a_normal_that_is_not_scaled() -> void:
	var boundary := WorldBoundaryShape2D.new()
	boundary.normal = Vector2(0, -1)
	boundary.distance = -50.0
	var reader := _read(boundary, Transform2D(0.0, Vector2(2, 2), 0.0, Vector2.ZERO))
	assert_eq(reader.shapes[0]["kind"], "half_plane")
	_assert_points(reader, [0.0, -1.0, 0.0, 1.0])


func test_a_drawn_outline_stays_in_one_piece() -> void:
	var outline := CollisionPolygon2D.new()
	outline.polygon = [
		Vector2(0, 0),
		Vector2(30, 0),
		Vector2(30, 30),
		Vector2(20, 30),
		Vector2(20, 10),
		Vector2(0, 10)
	]
	var reader := _read_node(outline)
	assert_eq(reader.shapes.size(), 1)
	assert_eq((reader.shapes[0]["points"] as PackedFloat64Array).size(), 12)


func test_a_separation_ray_is_refused_with_a_reason() -> void:
	var reader := _read(SeparationRayShape2D.new())
	assert_eq(reader.shapes.size(), 0)
	assert_string_contains(reader.problems[0], "SeparationRayShape2D")


func test_an_empty_shape_is_named() -> void:
	assert_string_contains(_read(null).problems[0], "has no shape")


func test_a_disabled_shape_is_left_out() -> void:
	var holder := CollisionShape2D.new()
	holder.shape = CircleShape2D.new()
	holder.disabled = true
	assert_eq(_read_node(holder).shapes.size(), 0)


func test_a_one_way_shape_is_free_from_its_own_top() -> void:
	var holder := CollisionShape2D.new()
	holder.shape = RectangleShape2D.new()
	holder.one_way_collision = true
	holder.rotation = PI / 2.0
	var reader := _read_node(holder)
	var normal: PackedFloat64Array = reader.shapes[0]["one_way_normal"]
	# its top looks to the right of the screen
	assert_almost_eq(normal[0], 1.0, 1e-6)
	assert_almost_eq(normal[1], 0.0, 1e-6)
