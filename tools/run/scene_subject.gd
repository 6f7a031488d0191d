extends RefCounted
## The scene that a report is made of: whether it can be, and a fresh copy of it for every run.

const Runs := preload("res://tools/run/scene_runs.gd")
const WorldSettings := preload("res://addons/haptics/nodes/world_settings.gd")

# where a hand feels its way when the scene has none that moves by itself: out and back in four
# directions, 30 mm each
const _TIMES: PackedFloat64Array = [0.0, 0.4, 0.9, 1.4, 1.9, 2.4, 2.9, 3.4, 3.9]
const _REACH := 0.03
const _STIFFNESS := 1000.0

## The scene.
var path := ""
## Why no report can be made; empty when one can.
var problem := ""
## What the report has to say about the scene.
var notes: PackedStringArray = []
## The present copy.
var scene: Node
var world: HapticWorld2D
## How the scene has it: method, integrator, rate_hz.
var own := {}

var _packed: PackedScene
# the gains that the scene's own rate gets
var _gains := {}


func _init(given: String) -> void:
	path = given
	if path != "" and not path.contains("://") and FileAccess.file_exists("res://" + path):
		path = "res://" + path
	problem = _find_problem()
	if problem != "":
		return
	make(Runs.as_it_is(0), 1.0)
	own = {
		"method": _method_of(world),
		"integrator": WorldSettings.INTEGRATORS[world.integrator],
		"rate_hz": world.rate,
	}
	free_scene()


## A fresh copy, set up for that run.
func make(run: Dictionary, seconds: float) -> Node:
	scene = _packed.instantiate()
	world = _find_world(scene)
	world.mode = HapticWorld2D.Mode.LOCKSTEP
	world.auto_start = true
	world.show_neighborhood = false
	world.record_seconds = seconds + 1.0
	_give_device()
	match run["role"]:
		Runs.EVERYTHING:
			world.set_meta(WorldSettings.WHOLE_SCENE, true)
		Runs.SETTING, Runs.REFERENCE:
			_set_method(run)
			_fix_loop()
		Runs.LOOP:
			_set_method(run)
			_stiffen(run["stiffer"] as float)
	return scene


## Takes it down.
func free_scene() -> void:
	if world != null and is_instance_valid(world):
		world.stop()
	if scene != null and is_instance_valid(scene):
		scene.free()
	scene = null
	world = null


## Keeps what the run of the scene as it is has shown.
func keep(figures: Dictionary) -> void:
	_gains = {
		&"coupling_stiffness": figures["coupling_stiffness_n_m"],
		&"coupling_damping": figures["coupling_damping_n_s_m"],
		&"coupling_rotation_stiffness": figures["coupling_stiffness_n_m_rad"],
		&"coupling_rotation_damping": figures["coupling_damping_n_m_s_rad"],
	}


## The contact of the tool with that surface: stiffness, damping, friction (static, dynamic),
## restitution and the mass of what touches.
func wall(surface: HapticSurface) -> Array:
	var tool := world.get_tool()
	var other := tool.surface
	if other == null:
		return [
			surface.stiffness,
			surface.damping,
			surface.static_friction,
			surface.dynamic_friction,
			surface.restitution,
			tool.mass,
		]
	return [
		_in_series(surface.stiffness, other.stiffness),
		_in_series(surface.damping, other.damping),
		minf(surface.static_friction, other.static_friction),
		minf(surface.dynamic_friction, other.dynamic_friction),
		maxf(surface.restitution, other.restitution),
		tool.mass,
	]


## Lines for the head of the report: what, value.
func describe(seconds: float, figures: Dictionary) -> Array[Array]:
	var lines: Array[Array] = [
		["scene", path],
		["scene time of a run, s", seconds],
		["rate, Hz", own["rate_hz"]],
		["integrator", own["integrator"]],
		["contact", own["method"]],
		["coupling stiffness, N/m", figures["coupling_stiffness_n_m"]],
		["coupling damping, N s/m", figures["coupling_damping_n_s_m"]],
		["solver", figures["kernel"]],
		["godot", Engine.get_version_info()["string"]],
		["ticks a second", Engine.physics_ticks_per_second],
	]
	for stage: Dictionary in figures["plan"]:
		if not stage["runs"] and stage["stage"] != "recorder":
			lines.append(["left out: %s" % stage["stage"], stage["reason"]])
	return lines


func _find_problem() -> String:
	if path == "":
		return "no scene was given: make report SCENE=res://scenes/….tscn"
	if not path.begins_with("res://") and not path.begins_with("uid://"):
		return "%s is no path in the project: give one that begins with res://" % path
	if not ResourceLoader.exists(path):
		return "there is no scene %s in the project." % path
	var broken := _find_broken(path, {})
	if broken != "":
		return (
			"%s cannot be loaded: %s does not parse; the errors above say where." % [path, broken]
		)
	_packed = load(path) as PackedScene
	if _packed == null or not _packed.can_instantiate():
		return "%s is no scene that can be loaded; the errors above say why." % path
	var copy := _packed.instantiate()
	if copy == null:
		return "%s cannot be instantiated; the errors above say why." % path
	var found := _find_world(copy) != null
	copy.free()
	if not found:
		return "%s has no HapticWorld2D. Add one: without it nothing is felt." % path
	return ""


# the first file that cannot be loaded of those that the scene is made of
func _find_broken(part: String, seen: Dictionary) -> String:
	if seen.has(part):
		return ""
	seen[part] = true
	if part.get_extension() == "gd":
		var script := load(part) as GDScript
		return "" if script != null and script.can_instantiate() else part
	for dependency: String in ResourceLoader.get_dependencies(part):
		var parts := dependency.split("::")
		var file := parts[parts.size() - 1]
		if file.get_extension() in ["gd", "tscn", "tres"]:
			if not ResourceLoader.exists(file):
				return "%s, which is missing," % file
			var broken := _find_broken(file, seen)
			if broken != "":
				return broken
	return "" if load(part) != null else part


static func _find_world(root: Node) -> HapticWorld2D:
	if root is HapticWorld2D:
		return root as HapticWorld2D
	for node: Node in root.find_children("*", "Node2D", true, false):
		if node is HapticWorld2D:
			return node as HapticWorld2D
	return null


# a device that is simulated, in a hand that moves by itself
func _give_device() -> void:
	var device := world.device as HapticSimulatedPantograph
	if device == null:
		var was := "no device" if world.device == null else "a real device"
		_note("the scene has %s; it was run with a simulated one of 0.3 kg" % was)
		device = HapticSimulatedPantograph.new()
		device.measures_force = true
	else:
		device = device.duplicate() as HapticSimulatedPantograph
	var hand := device.hand_for(true)
	if hand == null or hand.kind in [HapticSimulatedHand.Kind.NONE, HapticSimulatedHand.Kind.MOUSE]:
		_note(
			"no hand of the scene's moves by itself; one felt its way 30 mm down, left, up and right"
		)
		device.hand_unattended = _feeling_hand()
	world.device = device


static func _feeling_hand() -> HapticSimulatedHand:
	var hand := HapticSimulatedHand.new()
	hand.kind = HapticSimulatedHand.Kind.RECORDED_PATH
	hand.stiffness = _STIFFNESS
	hand.path_times = _TIMES
	var points := PackedVector3Array([Vector3.ZERO])
	for way: Vector2 in [Vector2.DOWN, Vector2.LEFT, Vector2.UP, Vector2.RIGHT]:
		points.append(Vector3(way.x, way.y, 0.0) * _REACH)
		points.append(Vector3.ZERO)
	hand.path = points
	hand.repeat = true
	return hand


func _set_method(run: Dictionary) -> void:
	var method: String = run["method"]
	world.rate = run["rate_hz"]
	world.integrator = WorldSettings.INTEGRATORS.find(run["integrator"] as String)
	world.contact = (
		HapticWorld2D.Contact.PENALTY
		if method == "penalty"
		else HapticWorld2D.Contact.PENALTY_IMPULSE
	)
	world.collision_method = (
		HapticWorld2D.CollisionMethod.PAPER
		if method == "paper"
		else HapticWorld2D.CollisionMethod.POISSON
	)


static func _method_of(of: HapticWorld2D) -> String:
	if of.contact == HapticWorld2D.Contact.PENALTY:
		return "penalty"
	var paper := of.collision_method == HapticWorld2D.CollisionMethod.PAPER
	return "paper" if paper else "penalty_impulse"


# the same continuous motion at every rate
func _fix_loop() -> void:
	for property: StringName in _gains:
		world.set(property, _gains[property])
	(world.device as HapticSimulatedPantograph).encoder_model = (
		HapticSimulatedPantograph.EncoderModel.EXACT
	)


# surfaces belong to the packed scene, so copies get stiffer
func _stiffen(factor: float) -> void:
	if factor == 1.0:
		return
	world.default_surface = _stiffer(world.default_surface, factor)
	if world.default_surface == null:
		world.default_surface = _stiffer(HapticSurface.new(), factor)
	var nodes := scene.find_children("*", "", true, false)
	nodes.append(scene)
	for node: Node in nodes:
		for property: StringName in [&"surface", &"haptic_surface"]:
			var surface: Variant = node.get(property)
			if surface is HapticSurface and not node is HapticTool2D:
				node.set(property, _stiffer(surface as HapticSurface, factor))
		if node.has_meta(&"haptic_surface"):
			var noted := node.get_meta(&"haptic_surface") as HapticSurface
			node.set_meta(&"haptic_surface", _stiffer(noted, factor))


static func _stiffer(surface: HapticSurface, factor: float) -> HapticSurface:
	if surface == null:
		return null
	var copy := surface.duplicate() as HapticSurface
	copy.stiffness *= factor
	return copy


static func _in_series(a: float, b: float) -> float:
	return a * b / (a + b) if a + b > 0.0 else 0.0


func _note(text: String) -> void:
	if not text in notes:
		notes.append(text)
