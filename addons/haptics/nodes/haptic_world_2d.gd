@tool
@icon("res://addons/haptics/icons/haptic_world_2d.svg")
class_name HapticWorld2D
extends Node2D
## The haptic side of a scene: runs the loop that holds the device, and keeps its picture of what
## lies around the tool fresh at every physics tick.
##
## One per World2D. Add it with a [HapticTool2D] anywhere in the scene; bodies that the tool's
## collision_mask selects can be felt. Its origin is the origin of the device's workspace; its scale
## has to stay 1. All signals come on the main thread. Mapping, gravity, [member default_surface]
## and what the tool's collision_mask selects count at once when they change while the world runs;
## all else of world, device and tool counts from the next start, and a warning says so.

## The loop runs.
signal started
## The loop ended.
signal stopped
## The output went off, and stays off until [method arm]; `fault` says why and what to do.
signal fault_raised(fault: String)
## Another tool, or another link of a linkage, is held; either may be null.
signal tool_changed(from: HapticTool2D, to: HapticTool2D)
## A button of the device went down or up. Comes in the physics tick: [method take_at] may follow.
signal button_changed(button: int, pressed: bool)
## More lies within reach of the tool than the loop can hold: of that, `left_out` convex pieces
## cannot be felt, the farthest. Said when it begins; an error says it too, once.
signal neighborhood_overflowed(left_out: int)

## What drives the haptic steps.
enum Mode {
	## A thread of its own, in real time.
	REALTIME,
	## The physics tick: repeatable bit for bit, for tests, experiments and recordings.
	LOCKSTEP,
}

## How device and tool are tied together.
enum Coupling {
	## Positions and forces go both ways.
	FOUR_CHANNEL,
	## A spring and a damper between them.
	VIRTUAL_COUPLING,
	## The device is the tool.
	DIRECT,
}

## What happens when a contact closes.
enum Contact {
	## A collision impulse, and spring and damper afterwards.
	PENALTY_IMPULSE,
	## Spring and damper alone.
	PENALTY,
}

## How contacts are integrated in time.
enum Integrator {
	## Stable for every stiffness and mass; damps fast contact modes.
	LINEARLY_IMPLICIT,
	## Cheapest; needs m > (K h² + 2 B h) / 4 per contact, else steps are linearly implicit.
	SEMI_IMPLICIT,
	## Solves contacts exactly from event to event within the step: a bounce loses only what its damper
	## takes, however stiff. Costs several times more. Where it does not apply, the linearly implicit
	## one takes over; [code]exact_gave_way[/code] in run.json and run.csv counts these steps.
	EXACT,
}

## How collisions of several contacts at once are resolved.
enum CollisionMethod {
	## Compression and restitution, impulses never pull, energy never grows.
	POISSON,
	## Prescribed rebound weighted by mass, for comparison.
	MASS_WEIGHTED,
	## Equation (5) of the paper as printed, for comparison.
	PAPER,
}

## Where the gravity of tools and linkages comes from.
enum GravitySource {
	## None: a planar device lies flat.
	NONE,
	## The World2D's, in px/s² over [member pixels_per_meter].
	PROJECT,
	## [member gravity].
	CUSTOM,
}

const Gateway := preload("gateway.gd")
const Warnings := preload("warnings.gd")
const Checks := preload("checks.gd")
const Session := preload("world_session.gd")
const WorldSettings := preload("world_settings.gd")
const Tools := preload("tools.gd")
const Reports := preload("world_reports.gd")
const DeviceButtons := preload("device_buttons.gd")
const StopKey := preload("stop_key.gd")
const NeighborhoodView := preload("neighborhood_view.gd")

## Group of all haptic worlds in the tree.
const WORLDS := &"_haptic_worlds"
## Group of all tools in the tree.
const TOOLS := &"_haptic_tools"

const _AFTER_ALL_ELSE := 1000

## What the user holds.
@export var device: HapticDevice
## Haptic steps a second, Hz, 250 to 10000.
@export_range(250.0, 10000.0, 1.0, "suffix:Hz") var rate: float = 1000.0
## How large the scene feels, px/m: at 4000 a workspace of 16 cm is 640 px wide.
@export_range(1.0, 100000.0, 1.0, "or_greater", "exp", "suffix:px/m")
var pixels_per_meter: float = 4000.0
## Surface of bodies that have none of their own; without one the paper's wall.
@export var default_surface: HapticSurface
## What every force is held to; without one the defaults.
@export var safety: HapticSafetyLimits

@export_group("Running")
## What drives the haptic steps.
@export var mode: Mode = Mode.REALTIME
## Starts with the scene.
@export var auto_start: bool = true
## Arms as soon as the handle rests in free space; else [method arm] does.
@export var arm_at_start: bool = true
## The tool is held from the start; else [method hold] takes it.
@export var hold_at_start: bool = true
## How much of the run is recorded for [method save_recording], s, 0 to 3600.
@export_range(0.0, 600.0, 0.1, "or_greater", "suffix:s") var record_seconds: float = 0.0

## Draws what the loop knows of the scene: bodies by who moves them, and how far was looked.
@export var show_neighborhood: bool = false:
	set = set_show_neighborhood

@export_group("Method")
## How device and tool are tied together.
@export var coupling: Coupling = Coupling.FOUR_CHANNEL
## What happens when a contact closes.
@export var contact: Contact = Contact.PENALTY_IMPULSE
## How contacts are integrated in time.
@export var integrator: Integrator = Integrator.LINEARLY_IMPLICIT
## How collisions of several contacts at once are resolved.
@export var collision_method: CollisionMethod = CollisionMethod.POISSON
## Approach slower than this gives no collision impulse, m/s.
@export_range(0.0001, 0.1, 0.0001, "or_greater", "suffix:m/s") var collision_speed: float = 0.005
## Stiffness of the coupling, N/m; 0 chooses it from rate, delay and masses.
@export_range(0.0, 20000.0, 1.0, "or_greater", "suffix:N/m") var coupling_stiffness: float = 0.0
## Damping of the coupling, N s/m; 0 chooses it.
@export_range(0.0, 200.0, 0.1, "or_greater", "suffix:N s/m") var coupling_damping: float = 0.0
## Stiffness of the coupling in rotation, N m/rad; 0 chooses it.
@export_range(0.0, 100.0, 0.001, "or_greater", "suffix:N m/rad")
var coupling_rotation_stiffness: float = 0.0
## Damping of the coupling in rotation, N m s/rad; 0 chooses it.
@export_range(0.0, 1.0, 0.0001, "or_greater", "suffix:N m s/rad")
var coupling_rotation_damping: float = 0.0
## Longest window of the velocity estimate, samples: longer is quieter and lags more; 0 chooses it.
@export_range(0, 63) var velocity_window: int = 0
## Estimates the handle's motion and the force of the hand with a model of the device, and chooses
## the coupling that goes with it: stiffer walls, and four channels without a force
## sensor. Needs a device whose mass is known to within [member observer_mass_error].
@export var observer: bool = false
## Force noise that a coarse encoder may cause (deviation); more allows a stiffer coupling.
@export_range(0.01, 1.0, 0.01, "or_greater", "suffix:N") var observer_noise: float = 0.05
## Largest relative error of the device's mass that has to stay stable.
@export_range(0.0, 0.5, 0.01) var observer_mass_error: float = 0.25
## Part of the device's inertia that is kept from the hand in free motion, 0 to 0.95. Needs
## [constant FOUR_CHANNEL], and [member observer] or a device that measures the hand's force.
@export_range(0.0, 0.95, 0.01) var hidden_inertia: float = 0.0
## Damps the handle while the loop gave more energy than it got. On anyway with hidden inertia.
@export var passivity_control: bool = false

@export_group("Gravity")
## Where the gravity of tools and linkages comes from. Rigid bodies fall as Godot lets them.
@export var gravity_source: GravitySource = GravitySource.NONE
## Gravity of [constant CUSTOM], in the axes of the screen (y down).
@export_custom(PROPERTY_HINT_NONE, "suffix:m/s²") var gravity: Vector2 = Vector2.ZERO

@export_group("Mapping", "mapping")
## Meters in the scene per meter at the device; a wall feels s² times as stiff. What changes of the
## mapping while the world runs comes without a jump: the force fades out and in.
@export_range(0.1, 10.0, 0.001, "or_greater") var mapping_scale: float = 1.0
## Turn of the device's axes in the scene, rad, clockwise.
@export_range(-180.0, 180.0, 0.1, "radians_as_degrees") var mapping_rotation: float = 0.0
## Angle added to the handle's, rad, clockwise, any number of turns, followed at up to 10 rad/s.
## With a device of two freedoms this alone turns the tool.
@export_range(-360.0, 360.0, 0.1, "or_less", "or_greater", "radians_as_degrees")
var mapping_turn: float = 0.0
## The tool stays where it is and the handle moves freely, to be put elsewhere in its workspace.
var clutched: bool = false

var _unattended := DisplayServer.get_name() == "headless"
var _warnings := Warnings.new(self, Checks.of_world.bind(self))
var _buttons := DeviceButtons.new(self)
var _session: Session
var _wants_start := false
var _chosen: HapticTool2D
var _last_tool: HapticTool2D
var _view: Node2D


func _notification(what: int) -> void:
	match what:
		NOTIFICATION_ENTER_TREE:
			add_to_group(WORLDS)
			process_physics_priority = _AFTER_ALL_ELSE
			process_priority = -_AFTER_ALL_ELSE
			_wants_start = auto_start
		NOTIFICATION_EXIT_TREE:
			stop()
		NOTIFICATION_PAUSED, NOTIFICATION_UNPAUSED:
			if is_running():
				_session.pause(what == NOTIFICATION_PAUSED)
	_warnings.follow(what)


func _physics_process(delta: float) -> void:
	if Engine.is_editor_hint():
		return
	if _wants_start:
		_wants_start = false
		start()
	if is_running():
		_warnings.say_these(_session.tick(delta))
		_buttons.follow()


func _process(_delta: float) -> void:
	if is_running():
		_session.show()


func _input(event: InputEvent) -> void:
	if not Engine.is_editor_hint() and is_running() and StopKey.is_pressed(event):
		press_stop()


## The haptic world of that node's World2D; null without one.
static func find_for(node: CanvasItem) -> HapticWorld2D:
	if not node.is_inside_tree():
		return null
	for other: Node in node.get_tree().get_nodes_in_group(WORLDS):
		var world := other as HapticWorld2D
		if world != null and world.get_world_2d() == node.get_world_2d():
			return world
	return null


## Starts the loop. False, after errors that say why, when it cannot.
func start() -> bool:
	if is_running():
		return true
	if Engine.is_editor_hint() or Gateway.server() == null or find_for(self) != self:
		return false
	# before the loop moves it: a tool that starts inside of a wall is soon out of it
	if get_tool() != null:
		get_tool().tell_problems()
	var session := Session.new(self)
	_warnings.say_these(session.start())
	if not session.native.is_running():
		_warnings.say()
		return false
	_session = session
	tool_changed.emit(_last_tool, session.tool)
	started.emit()
	return true


## Puts a rigid tool, a link at its grip_point, or a body at `at` (its axes, px) into the hand. For
## another link of the linkage that is held the loop goes on, else it starts anew. A body is frozen
## for Godot while it is held, and given back with its velocity. False, after an error, when it
## cannot.
func take(what: CollisionObject2D, at := Vector2.ZERO) -> bool:
	var tool := Tools.for_hand(self, what, at)
	if tool == null:
		return false
	_chosen = tool
	var link := tool as HapticLink2D
	if is_running() and link == null and tool == _session.tool:
		return true
	if is_running() and link != null and link.get_linkage() == _session.linkage:
		return _session.grab(link)
	if is_running():
		_last_tool = _session.tool
		_session.stop()
		_session = null
	Tools.begin(self, tool)
	var is_taken := start()
	if not is_taken:
		Tools.forget(tool)
	_last_tool = null
	return is_taken


## Takes what can be held and lies at `point` (canvas): a tool, a link, a rigid body; there, unless
## it is a rigid tool. False when nothing does, and when it cannot. Physics tick only.
func take_at(point: Vector2) -> bool:
	return Tools.take_at(self, point)


## The body in the hand; null while a tool, a link or nothing is.
func get_held_body() -> RigidBody2D:
	return Tools.body_of(_session.tool) if is_running() else null


## The run that goes on; null while none does.
func get_run() -> Session:
	return _session


## Ends the loop and takes the force off.
func stop() -> void:
	if _session == null:
		return
	var was := _session.tool if is_instance_valid(_session.tool) else null
	_session.stop()
	_session = null
	tool_changed.emit(was, null)
	stopped.emit()


## True between start and stop.
func is_running() -> bool:
	return _session != null


## The tool of this world; null without one.
func get_tool() -> HapticTool2D:
	if _session != null and is_instance_valid(_session.tool):
		return _session.tool
	if is_instance_valid(_chosen) and _chosen.is_inside_tree():
		return _chosen
	return Tools.find_first(self) if is_inside_tree() else null


## Asks for force. It comes when the handle rests in free space; it clears faults.
func arm(armed: bool = true) -> void:
	if is_running():
		_session.native.arm(armed)


## Takes the force off at once, until [method arm].
func press_stop() -> void:
	if is_running():
		_session.native.press_stop()


## Gives a device with relative encoders its zero: its handle has to rest in the home pose now, with
## the force off. OK, or FAILED after errors that say why. Waits for the device, at most a second.
func home_device() -> Error:
	if not is_running():
		return Reports.say(self, ["the world does not run, so no device can be homed. Start it."])
	return Reports.say(self, _session.native.home_device())


## The hand takes hold of the tool, or lets go.
func hold(held: bool = true) -> void:
	if is_running():
		_session.native.hold(held)


## True when forces go to the device; get_statistics()["force_waits_for"] says what is missing.
func is_armed() -> bool:
	return is_running() and _session.state[Gateway.State.ARMED] > 0.0


## True while the hand holds the tool.
func is_held() -> bool:
	return is_running() and _session.state[Gateway.State.HELD] > 0.0


## True while that button of the device is down.
func is_button_pressed(button: int) -> bool:
	return _buttons.is_pressed(button)


## Force on the hand, N, canvas's axes, in the scene; the device gives mapping_scale times that.
func get_force() -> Vector2:
	return _vector(Gateway.State.FORCE_X)


## Torque on the hand, N m, clockwise.
func get_torque() -> float:
	return -_value(Gateway.State.TORQUE)


## Force of all contacts on the tool, N, in the canvas's axes.
func get_contact_force() -> Vector2:
	return _vector(Gateway.State.CONTACT_FORCE_X)


## Deepest overlap of tool and surroundings now, m.
func get_penetration() -> float:
	return _value(Gateway.State.PENETRATION)


## Speed of the tool's center of mass, m/s.
func get_speed() -> float:
	return _vector(Gateway.State.VELOCITY_X).length()


## Where the tool is held, on the canvas.
func get_grip() -> Transform2D:
	return _pose(Gateway.State.GRIP_X)


## Where the handle of the device is, on the canvas.
func get_handle() -> Transform2D:
	return _pose(Gateway.State.DEVICE_X)


## What touches now.
func get_contacts() -> Array[HapticContact]:
	return _session.get_contacts() if is_running() else ([] as Array[HapticContact])


## Latched faults, cause and remedy each.
func get_faults() -> PackedStringArray:
	return _session.native.get_faults() if is_running() else PackedStringArray()


## Figures of the run, named as in run.json; empty when it does not run.
func get_statistics() -> Dictionary:
	return _session.native.get_statistics() if is_running() else {}


## What a haptic step does and what it leaves out for this scene, a line each: the stage, and the
## reason when it is left out. Empty when it does not run.
func get_plan() -> PackedStringArray:
	return Reports.plan_of(get_statistics())


## The newest report, in the order of HapticServer.STATE_*, SI and y up; empty when it does not run.
func get_state() -> PackedFloat64Array:
	return _session.state if is_running() else PackedFloat64Array()


## Bodies in the last snapshot of the neighborhood.
func get_neighbor_count() -> int:
	return _session.neighborhood.near_count if is_running() else 0


## The convex pieces that the loop knows of, one Dictionary each: body (null when it is gone), kind
## ("fixed", "kinematic" or "movable"), one_way, half_plane, radius (px) and points (canvas; of a
## half-plane a point and one along its normal). For pictures, not for every frame of a game.
func get_neighborhood() -> Array[Dictionary]:
	return _session.get_neighborhood() if is_running() else ([] as Array[Dictionary])


## Where the loop was given a look at the scene: discs on the canvas (x, y, radius, px).
func get_reach() -> Array[Vector3]:
	return _session.neighborhood.discs if is_running() else ([] as Array[Vector3])


## Draws the neighborhood, or stops it.
func set_show_neighborhood(shown: bool) -> void:
	show_neighborhood = shown
	if not Engine.is_editor_hint():
		_view = NeighborhoodView.shown_for(self, _view, shown)


## Where a hand of kind MOUSE wants the grip, on the canvas (px, rad).
func aim(point: Vector2, angle: float) -> void:
	if is_running():
		_session.aim(point, angle)


## Writes the recording as CSV, one row a haptic step. OK, or FAILED after an error that says why.
func save_recording(path: String) -> Error:
	if not is_running():
		return Reports.say(self, ["there is no recording, because the world does not run."])
	return Reports.say(self, _session.native.save_recording(ProjectSettings.globalize_path(path)))


## True when nobody is there to move the device: without a display and in lock-step.
func is_unattended() -> bool:
	return _unattended or mode == Mode.LOCKSTEP


## Whether somebody is there to move the device. Before the start.
func set_unattended(unattended: bool) -> void:
	_unattended = unattended


## As the native side takes it.
func to_settings() -> Dictionary:
	return WorldSettings.of(self)


func _value(index: Gateway.State) -> float:
	return _session.state[index] if is_running() else 0.0


func _vector(first: Gateway.State) -> Vector2:
	return _session.vector(first) if is_running() else Vector2.ZERO


func _pose(first: Gateway.State) -> Transform2D:
	return _session.pose(first) if is_running() else global_transform


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
