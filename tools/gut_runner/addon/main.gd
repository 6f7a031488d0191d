extends SceneTree
## Entry point: `godot --headless -s res://addons/gut/main.gd` runs the suites and quits.


func _initialize() -> void:
	var script: GDScript = load("res://addons/gut/run.gd") as GDScript
	if script == null or not script.can_instantiate():
		quit(1)
		return
	var runner: Node = script.new() as Node
	runner.connect(&"ended", quit)
	root.add_child.call_deferred(runner)
	await runner.ready
	runner.call(&"run")
