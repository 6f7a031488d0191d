extends SceneTree
## Runs a scene for some seconds and writes what its haptic world did.
##
##   godot --headless --path . -s tools/run/scene_runner.gd -- --scene=res://….tscn
##     --seconds=5         of scene time
##     --lockstep          haptic steps from the physics tick, repeatable; add the engine's own
##                         --fixed-fps 60 before the -- to run as fast as it can
##     --out=DIR           for run.json and run.csv, default build/run
##     --summary           prints a summary
##     --unattended        the hand for when nobody is there, also with a window
##     --screenshot=FILE   saves pictures FILE-1.5.png …, at --at=1.5,4 (default: at the end)
##
## Exit codes: 0 done, 1 it could not be run or written, 2 no such scene or no HapticWorld2D in it.

const _NO_WORLD := 2
# the recording has this much room beyond the run, s
const _SPARE := 2.0

var _options := {
	"scene": "",
	"seconds": "5",
	"lockstep": "",
	"out": "build/run",
	"summary": "",
	"unattended": "",
	"screenshot": "",
	"at": "",
}
var _world: HapticWorld2D
var _ticks_left := 0
var _ticks := 0
var _shots: Array[float] = []
var _is_done := false


func _initialize() -> void:
	if not _read_options() or not _load():
		return
	_ticks_left = roundi(_seconds() * Engine.physics_ticks_per_second)
	for moment: String in (_options["at"] as String).split(",", false):
		_shots.append(moment.to_float())
	if _options["screenshot"] != "" and _shots.is_empty():
		_shots.append(_seconds())


func _physics_process(_delta: float) -> bool:
	if _is_done or _world == null:
		return _is_done
	# the world starts with its first tick, which comes right after this
	if _ticks == 1 and not _world.is_running():
		_end(1, "The haptic world did not start; the errors above say why.")
		return true
	if _ticks >= _ticks_left and _shots.is_empty():
		_finish()
		return true
	_ticks += 1
	return false


func _process(_delta: float) -> bool:
	var now := float(_ticks) / Engine.physics_ticks_per_second
	if not _is_done and not _shots.is_empty() and now >= _shots[0]:
		var moment: float = _shots.pop_front()
		RenderingServer.frame_post_draw.connect(_take_picture.bind(moment), CONNECT_ONE_SHOT)
	return _is_done


func _read_options() -> bool:
	for argument: String in OS.get_cmdline_user_args():
		var parts := argument.trim_prefix("--").split("=", true, 1)
		if not argument.begins_with("--") or not _options.has(parts[0]):
			var known := " --".join(PackedStringArray(_options.keys()))
			return _end(1, "Unknown argument '%s'; known: --%s" % [argument, known])
		_options[parts[0]] = parts[1] if parts.size() > 1 else "yes"
	if _options["scene"] == "":
		return _end(_NO_WORLD, "No scene given: --scene=res://….tscn")
	if not (_seconds() > 0.0 and _seconds() <= 3600.0):
		return _end(1, "--seconds is %s, must be above 0 and at most 3600." % _options["seconds"])
	return true


func _load() -> bool:
	var path := _options["scene"] as String
	var packed: PackedScene
	if ResourceLoader.exists(path, "PackedScene"):
		packed = load(path) as PackedScene
	if packed == null:
		return _end(_NO_WORLD, "%s is no scene that can be loaded. Give a res:// path." % path)
	var scene := packed.instantiate()
	var worlds := scene.find_children("*", "Node2D", true, false)
	worlds.push_front(scene)
	for node: Node in worlds:
		if node is HapticWorld2D and _world == null:
			_world = node as HapticWorld2D
	if _world == null:
		scene.free()
		return _end(
			_NO_WORLD, "%s has no HapticWorld2D. Add one: without it nothing is felt." % path
		)
	_world.mode = (
		HapticWorld2D.Mode.LOCKSTEP if _options["lockstep"] != "" else HapticWorld2D.Mode.REALTIME
	)
	_world.record_seconds = _seconds() + _SPARE
	_world.auto_start = true
	if _options["unattended"] != "":
		_world.set_unattended(true)
	root.add_child(scene)
	current_scene = scene
	return true


func _finish() -> void:
	var report := HapticRunReport.new(_world, _options["scene"] as String)
	report.figures["seconds"] = _seconds()
	if report.write(ProjectSettings.globalize_path(_options["out"] as String)) != OK:
		_end(1, "The run could not be written.")
		return
	if _options["summary"] != "":
		print("\n", report.summary(), "\n")
	_end(0, "wrote %s" % (_options["out"] as String).path_join(HapticRunReport.FIGURES))


func _take_picture(moment: float) -> void:
	var file := _options["screenshot"] as String
	if _options["at"] != "":
		file = "%s-%s.png" % [file.trim_suffix(".png"), String.num(moment)]
	var picture := root.get_texture().get_image()
	if picture == null or picture.save_png(file) != OK:
		push_error("No picture at %s; pictures need a display." % file)


func _seconds() -> float:
	return (_options["seconds"] as String).to_float()


func _end(code: int, text: String) -> bool:
	_is_done = true
	if code == 0:
		print(text)
	else:
		printerr("scene_runner: ", text)
	# worlds stop before the tree goes
	if _world != null:
		_world.stop()
	quit(code)
	return false
