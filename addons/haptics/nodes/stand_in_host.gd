@tool
extends RefCounted
## Runs the linkages of a world whose own loop does not run: one lock-step loop for all of them, so
## that they meet as they do beside a tool. It holds a tool that touches nothing.

const Self := preload("stand_in_host.gd")
const Gateway := preload("gateway.gd")
const WorldSettings := preload("world_settings.gd")

# by instance id of the world; gone with the last linkage that uses it
static var _hosts: Dictionary[int, WeakRef] = {}

## The loop.
var native := Gateway.new()

var _world: HapticWorld2D


## The one of `world`; null when it cannot run.
static func of(world: HapticWorld2D) -> Self:
	var key := world.get_instance_id()
	var known: Self = _hosts[key].get_ref() if _hosts.has(key) else null
	if known != null and known.native.is_running():
		return known
	var host := new()
	if not host._start(world):
		return null
	_hosts[key] = weakref(host)
	return host


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and native != null and native.is_running():
		native.stop()


func _start(world: HapticWorld2D) -> bool:
	_world = world
	if not native.is_valid():
		return false
	var point := {
		"id": 1, "kind": "circle", "points": PackedFloat64Array([0.0, 0.0]), "radius": 0.001
	}
	var wrong := native.configure(WorldSettings.without_hand(world))
	wrong.append_array(native.set_device({"kind": "simulated_pantograph"}))
	wrong.append_array(native.set_tool({"body": {"kind": "tool", "mass": 0.1, "shapes": [point]}}))
	if not wrong.is_empty() or not native.start(false, 0.0).is_empty():
		return false
	# before the nodes of a tick: these then hand over what they see for the next one
	world.get_tree().physics_frame.connect(_tick)
	return true


func _tick() -> void:
	if is_instance_valid(_world) and _world.is_inside_tree() and _world.can_process():
		native.advance(_world.get_physics_process_delta_time())
