@tool
extends RefCounted
## A linkage that nobody holds: the same native dynamics and contacts as when it is held.
##
## While the world runs, its loop steps the linkage too, and the tool and the links of all such
## linkages meet at every haptic step; else a loop in the physics tick does, without a tool. What
## finds no place in either runs alone: other linkages are bodies that move and do not yield. Walls
## and objects it meets as a tool does.

const Gateway := preload("gateway.gd")
const Neighborhood := preload("../environment/neighborhood.gd")
const LinkageReader := preload("../environment/linkage_reader.gd")
const WorldSettings := preload("world_settings.gd")
const StandInHost := preload("stand_in_host.gd")
const Reach := preload("../environment/reach.gd")

# a link may get so fast until the next tick, m/s
const _TOP_SPEED := 2.0
# a scene that is slower counts as this slow
const _LEAST_TIME_SCALE := 0.1
# changes that have no signal are looked for in so many ticks
const _TICKS_TO_LOOK := 30
# bit of the faults: the model ran away and was put back
const _RAN_AWAY := 1 << 13

var _native := Gateway.new()
var _linkage: HapticLinkage2D
var _links: Array[HapticLink2D] = []
var _world: HapticWorld2D
var _units: HapticUnits
var _neighborhood: Neighborhood
var _reach := Reach.new()
var _parts: Array[RID] = []
var _states: PackedFloat64Array = []
var _host: Gateway
var _stand_in: StandInHost
var _is_alone := false
var _at := Transform2D.IDENTITY
var _signature := 0
var _ticks := 0
var _fastest := 0.0
var _said_ran_away := false


func _init(linkage: HapticLinkage2D, world: HapticWorld2D) -> void:
	_linkage = linkage
	_world = world
	_units = HapticUnits.new(world.pixels_per_meter, world.global_transform)
	_neighborhood = Neighborhood.new(_native, _units)


## False when it cannot move; its checks say why.
func start() -> bool:
	_links = _linkage.get_links()
	if _links.is_empty() or not _native.is_valid():
		return false
	var problems := PackedStringArray()
	var wrong := _native.configure(WorldSettings.without_hand(_world))
	wrong.append_array(_native.set_device({"kind": "simulated_pantograph"}))
	wrong.append_array(
		_native.set_tool(LinkageReader.describe(_linkage, _links[-1], _units, problems))
	)
	if not wrong.is_empty():
		return false
	if _world.get_run() == null:
		_stand_in = StandInHost.of(_world)
	_host = _host_now()
	if _host == null or not _native.start_beside(_host).is_empty():
		_is_alone = true
		_native.start(false, 0.0)
	else:
		_neighborhood.push_links()
	_native.refresh()
	_states = _native.get_links()
	for link: HapticLink2D in _links:
		_parts.append(link.get_rid())
	_at = _linkage.global_transform
	_signature = LinkageReader.signature(_linkage, _units)
	return _native.is_running()


## True while it still is the linkage that was read.
func is_current() -> bool:
	if not _native.is_running() or not is_instance_valid(_world) or not _world.is_inside_tree():
		return false
	if _host_now() != _host:
		return false
	if _linkage.get_links() != _links or _linkage.global_transform != _at:
		return false
	_ticks += 1
	return _ticks % _TICKS_TO_LOOK != 0 or LinkageReader.signature(_linkage, _units) == _signature


func _host_now() -> Gateway:
	var run := _world.get_run()
	if run != null:
		return run.native
	return _stand_in.native if _stand_in != null else null


## True while it can be shown.
func is_current_run() -> bool:
	return _native.is_running() and _linkage.get_links() == _links


## One physics tick of so many seconds.
func tick(seconds: float) -> void:
	_native.refresh()
	_say_when_it_ran_away()
	var impulses := _native.take_impulses()
	var masks := PackedInt64Array()
	for link: HapticLink2D in _links:
		masks.append(link.collision_mask)
	var distance := func(extent: float, speed: float) -> float:
		return _reach.distance(extent, speed, _TOP_SPEED, seconds)
	_neighborhood.set_default_surface(_world.default_surface)
	_neighborhood.leave_out(_parts if _is_alone else _parts + _met_by_others())
	# the loop runs in real time: velocities of the scene go with its time scale, accelerations twice
	var scale := 1.0
	if not _is_alone and _stand_in == null and _world.mode == HapticWorld2D.Mode.REALTIME:
		scale = maxf(Engine.time_scale, _LEAST_TIME_SCALE)
	var pull := WorldSettings.pull_of(_world)
	_neighborhood.publish(
		_world.get_world_2d(),
		LinkageReader.reach(_linkage, _states, _units, distance),
		masks,
		seconds,
		scale,
		PackedFloat64Array([pull[0] * scale * scale, pull[1] * scale * scale])
	)
	_neighborhood.give(impulses, scale)
	if _is_alone:
		_native.advance(seconds)
	show()


# once; the loop has put it back, at rest
func _say_when_it_ran_away() -> void:
	for link: int in _links.size():
		var at := link * LinkageReader.STATE
		_fastest = maxf(_fastest, Vector2(_states[at + 3], _states[at + 4]).length())
	var faults := int(_native.get_state()[Gateway.State.FAULTS])
	if _said_ran_away or faults & _RAN_AWAY == 0:
		return
	_said_ran_away = true
	push_warning(
		(
			(
				"%s ran away (beyond 1000 km or 1000 km/s, or no number; its links had been seen at"
				+ " up to %.1f m/s) and was put back at rest. Make extreme figures milder: light"
				+ " links, stiff springs and surfaces, strong gravity, shapes inside of each other."
			)
			% [_linkage.get_path(), _fastest]
		)
	)


# The loop solves a contact of two once: the tool's run that with all linkages, and of two linkages
# that with the smaller number.
func _met_by_others() -> Array[RID]:
	var run := _world.get_run()
	var parts: Array[RID] = []
	if run != null:
		parts = run.get_parts()
	for linkage: HapticLinkage2D in _world.get_tree().get_nodes_in_group(LinkageReader.LINKAGES):
		var other := linkage.get_mover()
		if other != null and other.is_beside_tool() and other.comes_before(_native, _host):
			parts.append_array(other.get_parts())
	return parts


## Runs in the loop of `host` and meets the linkage of `native` there.
func comes_before(native: Gateway, host: Gateway) -> bool:
	return _host == host and _native.id() < native.id()


## The areas of its links.
func get_parts() -> Array[RID]:
	return _parts


## Stands still while the game is paused.
func set_paused(paused: bool) -> void:
	if _native.is_running():
		_native.set_paused(paused)


## Brings the links to where the native side has them.
func show() -> void:
	_native.refresh()
	_states = _native.get_links()
	_linkage.place(_states, _units)


## Ends it; the links stay where the native side had them last.
func stop() -> void:
	_native.stop()
	# on the way out of the tree links go first
	if _linkage.get_links() == _links and _links[0].is_inside_tree():
		_linkage.place(_native.get_links(), _units)
	_neighborhood.clear()


## Pose of the node of `link`, velocity of its center of mass: SI, y up.
func state_of(link: HapticLink2D) -> PackedFloat64Array:
	var at := _links.find(link) * LinkageReader.STATE
	return _states.slice(at, at + 6)


## True while the world's loop steps it.
func is_beside_tool() -> bool:
	return not _is_alone and _native.is_running()


## Body `number` of the world is `link`.
func tie(native: Gateway, number: int, link: HapticLink2D) -> void:
	native.tie_body(number, _native, _links.find(link))
