extends SceneTree
## Runs a scene again and again in lock-step, with every integrator, rate and method, and writes
## what the report makes its tables of (native/lab/report/scene.cpp).
##
##   godot --headless --fixed-fps 60 --path . -s tools/run/scene_sweep.gd -- --scene=res://….tscn
##     --out=DIR           for scene_*.csv and a track of each run
##     --seconds=3         of scene time a run
##     --quick             fewer rates, repeats and walls
##     --budget=S          of the wall's clock: runs get shorter where they would not fit
##
## Exit codes: 0 done, 1 it could not be run or written, 2 no such scene, one that does not parse,
## or no HapticWorld2D in it.

const Subject := preload("res://tools/run/scene_subject.gd")
const Runs := preload("res://tools/run/scene_runs.gd")
const Table := preload("res://tools/run/csv_table.gd")

const _BAD_SCENE := 2
# ticks between two runs, in which all that was freed goes
const _PAUSE := 3

var _options := {"scene": "", "out": "build/scene", "seconds": "3", "quick": "", "budget": "100"}
var _subject: Subject
var _table: Table
var _walls: Table
var _queue: Array[Dictionary] = []
var _total := 0
var _run := {}
var _ticks := 0
var _pause := 0
var _seconds := 3.0
var _began := 0
var _run_began := 0
var _first: Dictionary = {}
var _met: Dictionary[String, Array] = {}
var _most_bodies := 0
var _touching := 0
var _notes: PackedStringArray = []
var _is_done := false


func _initialize() -> void:
	for argument: String in OS.get_cmdline_user_args():
		var parts := argument.trim_prefix("--").split("=", true, 1)
		if not argument.begins_with("--") or not _options.has(parts[0]):
			var known := " --".join(PackedStringArray(_options.keys()))
			_end(1, "Unknown argument '%s'; known: --%s" % [argument, known])
			return
		_options[parts[0]] = parts[1] if parts.size() > 1 else "yes"
	_seconds = (_options["seconds"] as String).to_float()
	if not (_seconds >= 0.5 and _seconds <= 20.0):
		_end(1, "SECONDS is %s; a run takes 0.5 to 20 s of scene time." % _options["seconds"])
		return
	_subject = Subject.new(_options["scene"] as String)
	if _subject.problem != "":
		_end(_BAD_SCENE, _subject.problem)
		return
	var folder := _options["out"] as String
	if DirAccess.make_dir_recursive_absolute(folder) != OK:
		_end(1, "%s cannot be made. Choose a folder that can be written to." % folder)
		return
	_table = Table.new(folder.path_join("scene_runs.csv"), Runs.COLUMNS)
	_walls = Table.new(folder.path_join("scene_walls.csv"), Runs.WALL_COLUMNS)
	_began = Time.get_ticks_msec()
	_queue = [Runs.as_it_is(0)]


func _physics_process(_delta: float) -> bool:
	if _is_done or _table == null:
		return true
	if _pause > 0:
		_pause -= 1
		return false
	if _run.is_empty():
		_begin()
		return _is_done
	var world := _subject.world
	# the world starts with its first tick, which comes right after this
	if _ticks == 1 and not world.is_running():
		_refuse("the haptic world did not start")
		return _is_done
	if _ticks > 1 and not world.is_running():
		_refuse("the haptic world stopped after %.2f s" % _time())
		return _is_done
	_look(world)
	if _time() >= _seconds:
		_finish(world)
		return _is_done
	_ticks += 1
	return false


func _time() -> float:
	return float(_ticks) / Engine.physics_ticks_per_second


func _begin() -> void:
	_run = _queue.pop_front()
	_run["number"] = _table.size()
	_ticks = 0
	_touching = 0
	_most_bodies = 0
	_run_began = Time.get_ticks_msec()
	seed(1)
	root.add_child(_subject.make(_run, _seconds))
	current_scene = _subject.scene


# what the tool meets, in the run of the scene as it is
func _look(world: HapticWorld2D) -> void:
	if _ticks < 2:
		return
	_most_bodies = maxi(_most_bodies, world.get_neighbor_count())
	var run := world.get_run()
	var touched := run.native.get_touched()
	_touching += 1 if not touched.is_empty() else 0
	if _run["role"] != Runs.AS_IT_IS:
		return
	for number: int in touched:
		var surface := run.neighborhood.surface_of(number)
		var node := run.neighborhood.body_of(number)
		if surface != null and node != null:
			_met[str(_subject.scene.get_path_to(node))] = _subject.wall(surface)


func _finish(world: HapticWorld2D) -> void:
	var folder := _options["out"] as String
	var file := "track_%03d.csv" % (_run["number"] as int)
	var wrong := world.get_run().native.save_samples(
		ProjectSettings.globalize_path(folder.path_join(file)), Runs.INTERVAL
	)
	if not wrong.is_empty():
		_end(1, "The run could not be written: %s" % "; ".join(wrong))
		return
	var figures := world.get_statistics()
	_close(file, "", figures)
	if _first.is_empty():
		_first = figures
		_plan_runs(figures)
	_next()


func _refuse(why: String) -> void:
	if _first.is_empty():
		_end(1, "%s: %s; the errors above say why." % [_options["scene"], why])
		return
	_close("", why, {})
	_next()


func _close(file: String, why: String, figures: Dictionary) -> void:
	var row := _run.duplicate()
	row.merge(Runs.figures_of(figures))
	row["file"] = file
	row["why_not"] = why
	row["seconds"] = _seconds
	row["touching_ticks"] = _touching
	row["bodies"] = _most_bodies
	row["wall_ms"] = Time.get_ticks_msec() - _run_began
	_table.add(row)


func _next() -> void:
	_subject.free_scene()
	_run = {}
	_pause = _PAUSE
	printraw("\rrun %d of %d" % [_table.size(), maxi(_total, 1)])
	if _queue.is_empty():
		_write()
	elif Time.get_ticks_msec() - _began > 1000.0 * (_options["budget"] as String).to_float():
		# what is left are repeats, or the runs below have been made shorter already
		var left := _queue.filter(func(run: Dictionary) -> bool: return run["repeat"] == 0)
		if left.size() < _queue.size():
			_note("some runs were not repeated: the time was up")
		_queue.assign(left)
		if _queue.is_empty():
			_write()


# all runs, once it is known what one takes
func _plan_runs(figures: Dictionary) -> void:
	var quick: bool = _options["quick"] != ""
	_subject.keep(figures)
	_queue = Runs.all(_subject.own, quick)
	_total = _queue.size() + 1
	var once := _queue.filter(func(run: Dictionary) -> bool: return run["repeat"] == 0).size()
	var took := (Time.get_ticks_msec() - _began) * 1e-3
	var budget := (_options["budget"] as String).to_float()
	if took * once > 3.0 * budget:
		_seconds = maxf(0.5, _seconds * 3.0 * budget / (took * once))
		_seconds = snappedf(_seconds, 0.1)
		_note("a run of the scene takes %.1f s, so runs were cut to %.1f s" % [took, _seconds])


func _write() -> void:
	for path: String in _met:
		var figures: Array = _met[path]
		_walls.add(Runs.wall_row(path, figures))
	_notes.append_array(_subject.notes)
	if _met.is_empty():
		_note(
			(
				(
					"the tool never touched anything in %.1f s, so only free motion was measured: give the hand"
					+ " a path or a force that leads somewhere, or run longer (SECONDS=)"
				)
				% _seconds
			)
		)
	var scene := Table.new(
		(_options["out"] as String).path_join("scene.csv"), PackedStringArray(["what", "value"])
	)
	for line: Array in _subject.describe(_seconds, _first):
		scene.add({"what": line[0], "value": line[1]})
	for text: String in _notes:
		scene.add({"what": "note", "value": text})
		printerr("note: ", text)
	for table: Table in [_table, _walls, scene]:
		if not table.write():
			_end(1, "%s could not be written." % table.path)
			return
	_end(0, "%d runs of %s" % [_table.size(), _options["scene"]])


func _note(text: String) -> void:
	if not text in _notes:
		_notes.append(text)


func _end(code: int, text: String) -> void:
	_is_done = true
	if _subject != null:
		_subject.free_scene()
	if code == 0:
		print("\n", text)
	else:
		printerr("\nscene_sweep: ", text)
	quit(code)
