extends GutTest
## Pixels and meters.


func test_a_point_flips_y_and_is_divided_by_the_scale() -> void:
	var units := HapticUnits.new(4000.0)
	assert_eq(units.point_to_meters(Vector2(400, 200)), PackedFloat64Array([0.1, -0.05]))
	assert_eq(units.point_to_canvas(0.1, -0.05), Vector2(400, 200))


func test_an_angle_changes_its_sign() -> void:
	assert_almost_eq(HapticUnits.new(4000.0).angle_to_native(0.3), -0.3, 1e-12)
	assert_almost_eq(HapticUnits.new(4000.0).angle_to_canvas(-0.3), 0.3, 1e-12)


func test_impulse_and_inertia_grow_with_the_scale_and_its_square() -> void:
	var units := HapticUnits.new(100.0)
	assert_eq(units.impulse_to_canvas(2.0, 3.0), Vector2(200, -300))
	assert_almost_eq(units.angular_impulse_to_canvas(2.0), -20000.0, 1e-9)
	assert_almost_eq(units.inertia_to_meters(20000.0), 2.0, 1e-12)


func test_going_there_and_back_changes_nothing_in_a_turned_and_moved_world() -> void:
	var units := HapticUnits.new(3000.0, Transform2D(0.7, Vector2(5000, -2000)))
	var place := Transform2D(-0.4, Vector2(5123.5, -1890.25))
	var pose := units.pose_to_meters(place)
	var back := units.pose_to_canvas(pose[0], pose[1], pose[2])
	assert_almost_eq(back.origin, place.origin, Vector2(0.001, 0.001))
	assert_almost_eq(back.get_rotation(), -0.4, 1e-6)
	var velocity := units.velocity_to_meters(Vector2(30, -60))
	var again := units.vector_to_canvas(velocity[0], velocity[1]) * 3000.0
	assert_almost_eq(again, Vector2(30, -60), Vector2(0.001, 0.001))


func test_a_moved_and_turned_world_sees_its_own_scene_the_same() -> void:
	var frame := Transform2D(0.7, Vector2(5000, -2000))
	var local := Transform2D(0.2, Vector2(120, 40))
	var here := HapticUnits.new(4000.0).pose_to_meters(local)
	var there := HapticUnits.new(4000.0, frame).pose_to_meters(frame * local)
	for i: int in 3:
		# what single precision leaves 5000 px out
		assert_almost_eq(there[i], here[i], 3e-7)


func test_the_power_of_a_force_and_a_velocity_is_the_same_on_both_sides() -> void:
	var units := HapticUnits.new(4000.0, Transform2D(1.1, Vector2.ZERO))
	var force := Vector2(1.5, -2.0)
	var velocity := Vector2(300.0, 100.0)
	var f := units.vector_to_native(force)
	var v := units.velocity_to_meters(velocity)
	assert_almost_eq(f[0] * v[0] + f[1] * v[1], force.dot(velocity) / 4000.0, 1e-9)
