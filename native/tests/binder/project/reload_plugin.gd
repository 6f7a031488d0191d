@tool
extends EditorPlugin
## Reloads the test library when a file ask_N.txt appears, checks what runs then, and answers in
## answer_N.txt.

const EXTENSION: String = "res://binder_probe.gdextension"

var _round: int = 0
var _probe: BinderProbe
var _counted: BinderProbeCounted
var _server_id: int = 0
var _beats: int = -1


func _process(_delta: float) -> void:
	if FileAccess.file_exists("res://ask_quit.txt"):
		set_process(false)
		_probe.free()
		_counted = null
		get_tree().quit()
	elif _round == 0:
		_probe = BinderProbe.new()
		_probe.gain = 31.5
		_counted = BinderProbeCounted.new()
		_counted.label = "kept"
		_server_id = Engine.get_singleton("ProbeServer").get_instance_id()
		_answer(_state())
	elif FileAccess.file_exists("res://ask_%d.txt" % _round) and _beats < 0:
		var status: int = GDExtensionManager.reload_extension(EXTENSION)
		_beats = 0
		if status != GDExtensionManager.LOAD_STATUS_OK:
			_answer("reload_extension returned %d" % status)
	elif _beats >= 0:
		# frame callbacks and thread of the new code have to run, so look some frames later
		_beats += 1
		if _beats == 20:
			_beats = -1
			_answer(_state())


## What is wrong, or "generation N ok".
func _state() -> String:
	var server: Object = Engine.get_singleton("ProbeServer")
	var reloaded: bool = _round > 0
	var must_hold: Dictionary[String, bool] = {
		"new code runs": ProbeServer.get_generation() == _round,
		"the singleton is the same object": server.get_instance_id() == _server_id,
		"the singleton runs new code": server.call("get_generation") == _round,
		"the thread runs":
		ProbeServer.is_beating() and (not reloaded or ProbeServer.get_beats() > 0),
		"the frame callback runs": not reloaded or ProbeServer.get_frames() >= 10,
		"the startup callback ran once": not reloaded or ProbeServer.get_startups() == 1,
		"a plain object keeps its property": _probe.gain == 31.5,
		"a plain object runs": _probe.echo_int(5) == 5,
		"a plain object is notified": _probe.get_reloaded() == mini(_round, 1),
		"an object of the engine is seen": _probe.class_name_of(self) == "EditorPlugin",
		"a counted object keeps its property": _counted.label == "kept",
		"a counted object keeps its count": _counted.get_reference_count() == 1,
		"no plain object is made or lost": BinderProbe.count_alive() == 1,
		"no counted object is made or lost": BinderProbe.count_counted_alive() == 1,
	}
	for claim: String in must_hold:
		if not must_hold[claim]:
			return "does not hold: " + claim
	return "generation %d ok" % _round


func _answer(text: String) -> void:
	var file: FileAccess = FileAccess.open("res://answer_%d.tmp" % _round, FileAccess.WRITE)
	file.store_string(text)
	file.close()
	DirAccess.rename_absolute("res://answer_%d.tmp" % _round, "res://answer_%d.txt" % _round)
	_round += 1
