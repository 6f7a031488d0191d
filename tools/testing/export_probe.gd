extends Node
## Rides in the exported game of export_test.sh: lets the main scene run, then says what is in the
## game and what its haptic world did, and quits.

const _SECONDS := 3.0


func _ready() -> void:
	print("build: ", "debug" if OS.is_debug_build() else "release")
	for file: String in _files("res://"):
		print("packed: ", file)
	await get_tree().create_timer(_SECONDS).timeout
	var worlds := get_tree().get_nodes_in_group(HapticWorld2D.WORLDS)
	var world: HapticWorld2D = worlds[0] if not worlds.is_empty() else null
	if world == null or not world.is_running():
		printerr("no haptic world runs")
		get_tree().quit(1)
		return
	var report := HapticRunReport.new(world, get_tree().current_scene.scene_file_path)
	print(report.summary())
	report.write(OS.get_executable_path().get_base_dir())
	world.stop()
	get_tree().quit()


func _files(folder: String) -> PackedStringArray:
	var found := PackedStringArray()
	for file: String in DirAccess.get_files_at(folder):
		found.append(folder.path_join(file))
	for below: String in DirAccess.get_directories_at(folder):
		found.append_array(_files(folder.path_join(below)))
	return found
