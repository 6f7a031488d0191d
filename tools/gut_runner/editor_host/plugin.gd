@tool
extends EditorPlugin
## Runs the suites named by the environment inside of the editor, then quits it.
## Without GUT_RUNNER_IN_EDITOR it does nothing, so that a staging project can be opened by hand.

const OURS := "res://addons/gut/run.gd"
const REAL := "res://addons/gut_host/real_run.gd"
## Frames that the editor gets to settle after its first scan.
const SETTLE_FRAMES := 10


func _ready() -> void:
	if not OS.get_environment("GUT_RUNNER_IN_EDITOR").is_empty():
		_run.call_deferred()


func _run() -> void:
	while EditorInterface.get_resource_filesystem().is_scanning():
		await get_tree().process_frame
	for _frame: int in SETTLE_FRAMES:
		await get_tree().process_frame
	var path: String = OURS if FileAccess.file_exists(OURS) else REAL
	var script: GDScript = load(path) as GDScript
	if script == null:
		printerr("[gut_runner] the runner %s does not load" % path)
		get_tree().quit(1)
		return
	var runner: Node = script.new() as Node
	add_child(runner)
	runner.connect(&"ended", get_tree().quit)
	runner.call(&"run")
