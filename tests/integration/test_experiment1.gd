extends GutTest
## The paper's first experiment as scenes: both settle to 2 N, the collision impulse sooner and with
## less bouncing.

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
	for column: String in ["t_s", "force_y_n", "max_penetration_m", "contacts"]:
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


func _last_departure(rows: Dictionary[String, PackedFloat64Array]) -> float:
	var last := 0.0
	for i: int in rows["t_s"].size():
		if absf(rows["force_y_n"][i] - 2.0) > 0.3:
			last = rows["t_s"][i]
	return last


func test_the_impulse_settles_sooner_and_shallower_than_spring_and_damper_alone() -> void:
	var penalty := await _run("experiment1_penalty.tscn")
	var impulse := await _run("experiment1_impulse.tscn")
	for rows: Dictionary[String, PackedFloat64Array] in [penalty, impulse]:
		assert_almost_eq(_mean_of_last(rows["force_y_n"], 250), 2.0, 0.02)
		assert_almost_eq(_mean_of_last(rows["max_penetration_m"], 250), 2.0 / 15000.0, 1.4e-6)
	assert_lt(_times_lost(impulse["contacts"]), _times_lost(penalty["contacts"]))
	assert_lt(_last_departure(impulse), _last_departure(penalty))
	var deepest := Array(impulse["max_penetration_m"]).max() as float
	assert_lt(deepest, 0.6 * (Array(penalty["max_penetration_m"]).max() as float))
