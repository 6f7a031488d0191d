extends GutTest
## Forces do not depend on how the scene is looked at or where it stands.

const Scene := preload("res://tests/support/haptic_scene.gd")

# what a camera, a place or a turn may change, of the force
const _CLOSE := 1e-3

const _FORCE := HapticWorld2D.Gateway.State.FORCE_Y

var _world: HapticWorld2D


func before_each() -> void:
	Scene.hurry()


func after_each() -> void:
	Scene.calm_down()


# The mean of hand force (N, along the world's own axes) and depth (m) while a hand that is held in
# place by a spring leans on a wall: a wall that is felt elsewhere, or turned, changes it.
func _lean(place: Transform2D, zoom: float = 1.0) -> Vector2:
	_world = Scene.make_world()
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.0], [1.2, 0.0, 0.006, 0.0]]
	)
	var wall := Scene.make_wall(Vector2(0, 70), Vector2(480, 40))
	var scene := Scene.gather([_world, Scene.make_tool(), wall])
	scene.transform = place
	var camera := Camera2D.new()
	camera.zoom = Vector2(zoom, zoom)
	scene.add_child(camera)
	add_child_autofree(scene)
	camera.make_current()
	await wait_physics_frames(150)
	var sum := Vector2.ZERO
	for i: int in 20:
		await wait_physics_frames(1)
		sum += Vector2(_world.get_state()[_FORCE], _world.get_penetration())
	assert_eq(_world.get_faults(), PackedStringArray())
	scene.queue_free()
	await wait_physics_frames(2)
	return sum / 20.0


func test_a_camera_s_zoom_does_not_change_the_force() -> void:
	var plain: Vector2 = await _lean(Transform2D.IDENTITY)
	# 3.5 mm past the wall, on a spring of 1000 N/m behind one of 15000 N/m
	assert_almost_eq(plain.y, plain.x / 15000.0, 1e-6)
	assert_between(plain.x, 2.5, 3.5)
	for zoom: float in [0.25, 4.0]:
		var seen: Vector2 = await _lean(Transform2D.IDENTITY, zoom)
		assert_almost_eq(seen.x, plain.x, _CLOSE * plain.x, "force at zoom %s" % zoom)
		assert_almost_eq(seen.y, plain.y, _CLOSE * plain.y, "depth at zoom %s" % zoom)


func test_a_world_moved_and_turned_within_ten_thousand_pixels_feels_the_same() -> void:
	var plain: Vector2 = await _lean(Transform2D.IDENTITY)
	for place: Transform2D in [
		Transform2D(0.0, Vector2(10000, 0)),
		Transform2D(PI / 2.0, Vector2(0, -10000)),
		Transform2D(2.5, Vector2(7000, 7000)),
	]:
		var felt: Vector2 = await _lean(place)
		assert_almost_eq(felt.x, plain.x, _CLOSE * plain.x, "force at %s" % place)
