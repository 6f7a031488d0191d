extends Node
## Runs suites through GUT inside of the editor, where its command line cannot go.

## Emitted when the results have been written.
signal ended

const HOOK := "res://addons/gut_host/results_hook.gd"


## Runs the folders named by GUT_RUNNER_DIRS.
func run() -> void:
	var gut: Variant = (load("res://addons/gut/gut.gd") as GDScript).new()
	gut.pre_run_script = HOOK
	gut.post_run_script = HOOK
	gut.include_subdirectories = true
	gut.ignore_pause_before_teardown = true
	gut.log_level = 1
	gut.logger.disable_printer("gui", true)
	# the editor itself keeps hundreds of nodes outside of the tree
	gut.logger.set_type_enabled(gut.logger.types.orphan, false)
	add_child(gut as Node)
	for directory: String in OS.get_environment("GUT_RUNNER_DIRS").split(","):
		gut.add_directory(directory)
	# not by GUT's register_logger: in the editor, static variables of scripts other than @tool
	# ones stay empty, and with its own empty it does nothing
	OS.add_logger(gut.error_tracker as Logger)
	gut.end_run.connect(func() -> void: ended.emit())
	gut.test_scripts()
