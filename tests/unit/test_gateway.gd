extends GutTest
## The gateway says the same as the native class that it stands before.

const Gateway := preload("res://addons/haptics/nodes/gateway.gd")


func test_the_library_is_there() -> void:
	assert_true(Gateway.is_available())
	assert_ne(Gateway.version(), "")


func test_the_places_in_the_state_are_those_of_the_native_class() -> void:
	for place: String in Gateway.State:
		assert_eq(
			ClassDB.class_get_integer_constant("HapticServer", "STATE_" + place),
			Gateway.State[place] as int,
			place
		)


func test_every_method_of_the_native_worlds_has_its_typed_twin() -> void:
	var script: GDScript = Gateway
	var twins: PackedStringArray = []
	for method: Dictionary in script.get_script_method_list():
		twins.append(method["name"] as String)
	for method: Dictionary in ClassDB.class_get_method_list("HapticServer", true):
		var method_name := method["name"] as String
		# made and freed with the handle itself
		if method_name.begins_with("world_") and not method_name in ["world_create", "world_free"]:
			assert_has(twins, method_name.trim_prefix("world_"))


func test_no_script_of_ours_names_the_native_class_in_code() -> void:
	var named: PackedStringArray = []
	for folder: String in ["nodes", "environment", "resources", "telemetry", "editor"]:
		var path := "res://addons/haptics".path_join(folder)
		for file: String in DirAccess.get_files_at(path):
			if file.get_extension() != "gd":
				continue
			for line: String in FileAccess.get_file_as_string(path.path_join(file)).split("\n"):
				var code := line.get_slice("#", 0)
				if "HapticServer" in code and not '&"HapticServer"' in code:
					named.append(file)
	assert_eq(named, PackedStringArray())
