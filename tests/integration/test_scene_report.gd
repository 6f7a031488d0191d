extends GutTest
## What `make report SCENE=` makes of a scene: which it takes, and the runs it is measured with.

const Subject := preload("res://tools/run/scene_subject.gd")
const Runs := preload("res://tools/run/scene_runs.gd")
const Table := preload("res://tools/run/csv_table.gd")
const Scene := preload("res://tests/support/haptic_scene.gd")
const PUSH := "res://scenes/02_steady_push/experiment1_impulse.tscn"


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func test_what_is_no_haptic_scene_is_told_apart() -> void:
	assert_string_contains(Subject.new("").problem, "SCENE=")
	assert_string_contains(Subject.new("res://no_such.tscn").problem, "no scene")
	assert_string_contains(Subject.new("/elsewhere/a.tscn").problem, "res://")
	var packed := PackedScene.new()
	var plain := Node2D.new()
	packed.pack(plain)
	plain.free()
	var path := "user://plain.tscn"
	assert_eq(ResourceSaver.save(packed, path), OK)
	assert_string_contains(Subject.new(path).problem, "project")
	assert_eq(Subject.new(PUSH.trim_prefix("res://")).problem, "")


func test_every_integrator_rate_and_method_runs_and_each_reference_is_twice_the_last() -> void:
	var own := {"method": "penalty", "integrator": "exact", "rate_hz": 1000.0}
	var seen := {}
	var references: PackedFloat64Array = []
	for run: Dictionary in Runs.all(own, false):
		var kind: String = run["role"]
		if run["repeat"] == 0 and kind == Runs.SETTING:
			seen["%s %s %s" % [run["method"], run["integrator"], run["rate_hz"]]] = true
		if kind == Runs.REFERENCE and run["method"] == "paper":
			references.append(run["rate_hz"] as float)
	assert_eq(seen.size(), 3 * 3 * 6)
	assert_eq(references.size(), 3)
	for i: int in 2:
		assert_eq(references[i + 1], 2.0 * references[i])
	for run: Dictionary in Runs.all(own, true):
		if run.has("rate_hz"):
			assert_eq(fmod((run["rate_hz"] as float) * Runs.INTERVAL, 1.0), 0.0)


# the world of a run that went for half a second, and its samples
func _run(subject: Subject, run: Dictionary) -> Dictionary:
	add_child(subject.make(run, 0.5))
	await wait_physics_frames(32)
	var world := subject.world
	var path := OS.get_user_data_dir().path_join("samples.csv")
	assert_eq(world.get_run().native.save_samples(path, Runs.INTERVAL), PackedStringArray())
	var figures := world.get_statistics()
	figures["samples"] = FileAccess.get_file_as_string(path).split("\n", false).size() - 1
	figures["bodies"] = world.get_neighbor_count()
	subject.free_scene()
	await wait_physics_frames(2)
	return figures


func test_runs_are_set_up_as_asked_and_the_scene_itself_is_left_as_it_was() -> void:
	var subject := Subject.new(PUSH)
	assert_eq(subject.own["rate_hz"], 500.0)
	var own := await _run(subject, Runs.as_it_is(0))
	assert_between(own["samples"] as int, 120, 140)
	subject.keep(own)
	var run := Runs.as_it_is(0)
	run.merge(
		{
			"role": Runs.REFERENCE,
			"method": "penalty",
			"integrator": "exact",
			"rate_hz": 32000.0,
			"stiffer": 1.0
		},
		true
	)
	var fine := await _run(subject, run)
	assert_eq(fine["haptic_rate_hz"], 32000.0)
	assert_between(fine["samples"] as int, 120, 140)
	assert_eq(fine["coupling_stiffness_n_m"], own["coupling_stiffness_n_m"])
	run.merge({"role": Runs.EVERYTHING}, true)
	var everything := await _run(subject, run)
	for stage: Dictionary in everything["plan"]:
		assert_true(stage["runs"] as bool, stage["stage"] as String)
	run.merge({"role": Runs.LOOP, "stiffer": 100.0, "rate_hz": 500.0}, true)
	subject.make(run, 0.5)
	var wall := subject.scene.find_children("*", "StaticBody2D", true, false)[0] as HapticWall2D
	assert_eq(wall.surface.stiffness, 1.5e6)
	subject.free_scene()
	subject.make(Runs.as_it_is(0), 0.5)
	wall = subject.scene.find_children("*", "StaticBody2D", true, false)[0] as HapticWall2D
	assert_eq(wall.surface.stiffness, 15000.0)
	subject.free_scene()


func test_a_table_keeps_commas_and_leaves_out_what_a_row_has_not() -> void:
	var path := OS.get_user_data_dir().path_join("table.csv")
	var table := Table.new(path, PackedStringArray(["a", "b"]))
	table.add({"a": "x, y", "other": 1})
	table.add({"b": 1.5e-9})
	assert_true(table.write())
	assert_eq(FileAccess.get_file_as_string(path), 'a,b\n"x, y",\n,1.5e-09\n')
