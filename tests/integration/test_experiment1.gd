extends GutTest
## The paper's first experiment as scenes: with the collision impulse the contact settles at 2 N,
## with spring and damper alone it keeps bouncing.

const Scene := preload("res://tests/support/haptic_scene.gd")
const FOLDER := "res://scenes/02_steady_push"
# the push begins at 1 s
const TICKS := 240


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


# rows of the recording of a variant, by column
func _run(variant: String) -> Dictionary[String, PackedFloat64Array]:
	var scene := (load(FOLDER.path_join(variant)) as PackedScene).instantiate()
	var world := scene.get_node("World") as HapticWorld2D
	world.record_seconds = 10.0
	add_child(scene)
	await wait_physics_frames(TICKS + 2)
	assert_eq(world.get_faults(), PackedStringArray())
	var path := OS.get_user_data_dir().path_join("experiment1.csv")
	assert_eq(world.save_recording(path), OK)
	scene.free()
	await wait_physics_frames(2)
	var lines := FileAccess.get_file_as_string(path).split("\n", false)
	var names := lines[0].split(",")
	var rows: Dictionary[String, PackedFloat64Array] = {}
	for column: String in ["force_y_n", "contact_force_y_n", "max_penetration_m", "contacts"]:
		var values := PackedFloat64Array()
		for line: String in lines.slice(1):
			values.append(line.split(",")[names.find(column)].to_float())
		rows[column] = values
	return rows


func _mean_of_last(values: PackedFloat64Array, count: int) -> float:
	var sum := 0.0
	for value: float in values.slice(-count):
		sum += value
	return sum / count


func _times_lost(contacts: PackedFloat64Array) -> int:
	var lost := 0
	for i: int in range(1, contacts.size()):
		lost += 1 if contacts[i - 1] > 0.0 and contacts[i] == 0.0 else 0
	return lost


func _swing_of_last(values: PackedFloat64Array, count: int) -> float:
	var last := Array(values.slice(-count))
	return (last.max() as float) - (last.min() as float)


func test_only_the_collision_impulse_settles() -> void:
	var penalty := await _run("experiment1_penalty.tscn")
	var impulse := await _run("experiment1_impulse.tscn")
	assert_almost_eq(_mean_of_last(impulse["force_y_n"], 250), 2.0, 0.02)
	assert_almost_eq(_mean_of_last(impulse["max_penetration_m"], 250), 2.0 / 15000.0, 1.4e-6)
	assert_lt(_times_lost(impulse["contacts"]), _times_lost(penalty["contacts"]))
	var quiet := _swing_of_last(impulse["contact_force_y_n"], 250)
	assert_lt(quiet, 0.2)
	assert_gt(_swing_of_last(penalty["contact_force_y_n"], 250), 10.0 * quiet)
