extends GutTest
## The same scene in lock-step gives the same rows, bit for bit.

const Scene := preload("res://tests/support/haptic_scene.gd")
# 7 s: a wall, a slide along it, and a push at the object
const TICKS := 420


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# hash of the rows of the testbed's first seconds
func _run(file: String) -> String:
	var scene := (load("res://scenes/01_testbed/testbed.tscn") as PackedScene).instantiate()
	var world := scene.get_node("World") as HapticWorld2D
	world.mode = HapticWorld2D.Mode.LOCKSTEP
	world.record_seconds = 10.0
	add_child(scene)
	await wait_physics_frames(TICKS + 10)
	assert_eq(world.get_faults(), PackedStringArray())
	assert_gt(world.get_statistics()["collisions"] as int, 1)
	var path := OS.get_user_data_dir().path_join(file)
	assert_eq(world.save_recording(path), OK)
	scene.free()
	await wait_physics_frames(2)
	var rows := FileAccess.get_file_as_string(path).split("\n", false)
	assert_gt(rows.size(), 1000 * TICKS / 60.0)
	return "\n".join(rows.slice(0, floori(1000 * TICKS / 60.0))).sha256_text()


func test_the_testbed_twice_gives_the_same_recording() -> void:
	var first := await _run("first.csv")
	var second := await _run("second.csv")
	assert_eq(first, second)
