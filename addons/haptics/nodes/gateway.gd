@tool
extends RefCounted
## The one way from scripts to the native singleton HapticServer, and a typed handle to one of its
## worlds.
##
## No script names the native class: one that does fails to parse where the library is missing, and
## takes every scene that uses it along. Everything here is SI, y up, relative to the world node.

## Places in [method get_state], the same as HapticServer.STATE_*.
enum State {
	STEP,
	TIME,
	TOOL_X,
	TOOL_Y,
	TOOL_ANGLE,
	GRIP_X,
	GRIP_Y,
	GRIP_ANGLE,
	DEVICE_X,
	DEVICE_Y,
	DEVICE_ANGLE,
	VELOCITY_X,
	VELOCITY_Y,
	VELOCITY_ANGLE,
	FORCE_X,
	FORCE_Y,
	TORQUE,
	CONTACT_FORCE_X,
	CONTACT_FORCE_Y,
	CONTACT_TORQUE,
	CONTACTS,
	COLLIDING,
	STICKING,
	SLIDING,
	PENETRATION,
	ENERGY_INJECTED,
	ARMED,
	HELD,
	FAULTS,
	BUTTONS,
	HAND_SHARE,
	COUNT,
}

const Self := preload("gateway.gd")

## What a user is told, once, where the library is missing.
const MISSING := (
	"The haptics library is not built for this system: run `make build`"
	+ " (or install the addon's binaries into addons/haptics/bin), then restart Godot."
	+ " Scenes open and run without it, but nothing can be felt."
)

const _SERVER := &"HapticServer"

static var _said_missing := false

var _world := 0


func _init() -> void:
	var native := server()
	if native != null:
		_world = native.world_create()


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and _world != 0 and Engine.has_singleton(_SERVER):
		Engine.get_singleton(_SERVER).world_free(_world)


## True where the native library is loaded.
static func is_available() -> bool:
	return Engine.has_singleton(_SERVER)


## The native singleton; null, after one message, where the library is missing.
static func server() -> Object:
	if Engine.has_singleton(_SERVER):
		return Engine.get_singleton(_SERVER)
	if not _said_missing:
		_said_missing = true
		if not Engine.is_editor_hint():
			push_error(MISSING)
	return null


## Version of the library, empty where it is missing.
static func version() -> String:
	return Engine.get_singleton(_SERVER).get_version() if is_available() else ""


## All figures of a pantograph that exists, keys as the properties of [HapticPantographGeometry].
## Empty where the library is missing.
static func pantograph_preset(preset: String) -> Dictionary:
	var native := server()
	return native.get_pantograph_preset(preset) if native != null else {}


## What is wrong with the figures of a pantograph, and what follows from them. Empty where the
## library is missing.
static func describe_pantograph(geometry: Dictionary) -> Dictionary:
	var native := server()
	return native.describe_pantograph(geometry) if native != null else {}


## Its number; 0 where the library is missing.
func id() -> int:
	return _world


## False where the library is missing: then nothing else here may be called.
func is_valid() -> bool:
	return _world != 0


## Rate, coupling, contact, mapping and safety. Returns what is wrong with them.
func configure(settings: Dictionary) -> PackedStringArray:
	return server().world_configure(_world, settings)


## What the hand holds. Returns what is wrong with it.
func set_tool(tool: Dictionary) -> PackedStringArray:
	return server().world_set_tool(_world, tool)


## What the hand holds it with. Returns what is wrong with it.
func set_device(device: Dictionary) -> PackedStringArray:
	return server().world_set_device(_world, device)


## A body of the environment. Returns what is wrong with it.
func set_body(body: int, description: Dictionary) -> PackedStringArray:
	return server().world_set_body(_world, body, description)


## Forgets a body.
func remove_body(body: int) -> void:
	server().world_remove_body(_world, body)


## Starts the loop: on a thread of its own, or step by step from [method advance].
func start(realtime: bool, record_seconds: float) -> PackedStringArray:
	return server().world_start(_world, realtime, record_seconds)


## Ends the loop and takes the force off.
func stop() -> void:
	server().world_stop(_world)


## What a simulated device had been sent last when the world stopped: N, N, N m; empty while it
## runs.
func get_last_force() -> PackedFloat64Array:
	return server().world_get_last_force(_world)


## True between start and stop.
func is_running() -> bool:
	return server().world_is_running(_world)


## Publishes what lies within the discs (x, y, radius each): eight numbers a body (pose, velocity,
## free fall). `masks` are the layers that the tool touches, of a linkage those of each link.
func submit(
	bodies: PackedInt64Array,
	states: PackedFloat64Array,
	tick_seconds: float,
	gravity: PackedFloat64Array,
	discs: PackedFloat64Array,
	masks: PackedInt64Array
) -> PackedStringArray:
	return server().world_submit(
		_world,
		bodies,
		states,
		tick_seconds,
		gravity,
		discs,
		masks,
		Engine.get_process_frames(),
		Engine.max_physics_steps_per_frame
	)


## Convex pieces within reach that did not fit into the last snapshot.
func get_left_out() -> int:
	return server().world_get_left_out(_world)


## The convex pieces of the last snapshot, for a picture.
func get_neighborhood() -> Array:
	return server().world_get_neighborhood(_world)


## Lock-step: runs the haptic steps of so many seconds. Returns how many those were.
func advance(seconds: float) -> int:
	return server().world_advance(_world, seconds)


## Takes the newest report of the loop in.
func refresh() -> void:
	server().world_refresh(_world)


## The newest report, in the order of [enum State].
func get_state() -> PackedFloat64Array:
	return server().world_get_state(_world)


## The patches that touch now.
func get_contacts() -> Array:
	return server().world_get_contacts(_world)


## The bodies that the tool touches now.
func get_touched() -> PackedInt64Array:
	return server().world_get_touched(_world)


## What happened to contacts since the last call, in time order.
func take_events() -> Array:
	return server().world_take_events(_world)


## What the tool gave to movable bodies since the last call: id, x, y (N s), angle (N m s) each.
func take_impulses() -> PackedFloat64Array:
	return server().world_take_impulses(_world)


## Latched faults, cause and remedy each.
func get_faults() -> PackedStringArray:
	return server().world_get_faults(_world)


## Counts how long the scene's part of a physics tick took, s.
func book_tick(seconds: float) -> void:
	server().world_book_tick(_world, seconds)


## Figures of the run so far, named as in run.json.
func get_statistics() -> Dictionary:
	return server().world_get_statistics(_world)


## Where a pointing hand wants the grip: x, y (m), angle (rad).
func aim(x: float, y: float, angle: float) -> void:
	server().world_aim(_world, PackedFloat64Array([x, y, angle]))


## The hand takes hold of the tool, or lets go.
func hold(held: bool) -> void:
	server().world_hold(_world, held)


## How the handle holds the tool from now on: mapping, clutch and turn. Returns what is wrong.
func place(placement: Dictionary) -> PackedStringArray:
	return server().world_place(_world, placement)


## While a linkage is the tool: the hand takes hold of another link, at x, y in the axes of its node
## (m), of the point alone or with `pose` of the angle too. Returns what is wrong.
func grab(link: int, point: PackedFloat64Array, pose: bool) -> PackedStringArray:
	return server().world_grab(_world, link, point, pose)


## Eight numbers for every link of a linkage that is the tool: pose of its node, velocity of its
## center of mass, coordinate and its rate.
func get_links() -> PackedFloat64Array:
	return server().world_get_links(_world)


## A linkage: starts it beside `host`, whose loop steps it then. Returns what is wrong.
func start_beside(host: Self) -> PackedStringArray:
	return server().world_start_beside(_world, host.id())


## A body that can be pushed is link `link` of `linkage`, which runs beside this world. Returns what
## is wrong.
func tie_body(body: int, linkage: Self, link: int) -> PackedStringArray:
	return server().world_tie_body(_world, body, linkage.id(), link)


## Number of the link that is held.
func get_held_link() -> int:
	return server().world_get_held_link(_world)


## Asks for force, or takes it off.
func arm(armed: bool) -> void:
	server().world_arm(_world, armed)


## Fades the force out while the game is paused.
func set_paused(paused: bool) -> void:
	server().world_set_paused(_world, paused)


## Takes the force off at once, until it is armed again.
func press_stop() -> void:
	server().world_press_stop(_world)


## The real device's handle is in its home pose now. Returns what is wrong.
func home_device() -> PackedStringArray:
	return server().world_home_device(_world)


## Writes what was recorded as CSV. Returns what went wrong.
func save_recording(path: String) -> PackedStringArray:
	return server().world_save_recording(_world, path)


## Writes the same in steps of `interval` (s, a whole number of haptic steps): where the grip then
## is, and the mean forces since the sample before. Returns what went wrong.
func save_samples(path: String, interval: float) -> PackedStringArray:
	return server().world_save_samples(_world, path, interval)
