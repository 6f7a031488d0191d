@tool
extends RefCounted
## One run of a haptic world, from start to stop: hands snapshots to the loop, brings its reports
## back into the scene.

const Gateway := preload("gateway.gd")
const Neighborhood := preload("../environment/neighborhood.gd")
const TouchSignals := preload("touch_signals.gd")
const Reach := preload("../environment/reach.gd")
const WorldSettings := preload("world_settings.gd")
const PlaceChecks := preload("place_checks.gd")
const ToolReader := preload("../environment/tool_reader.gd")
const HeldBody := preload("held_body.gd")
const StartFigures := preload("start_figures.gd")
const LinkageReader := preload("../environment/linkage_reader.gd")

# below this scale of time a scene counts as paused
const _LEAST_TIME_SCALE := 0.1
# px
const _EVERYWHERE := 1e6

## The native world.
var native := Gateway.new()
## What is held: a rigid tool, or a link of [member linkage].
var tool: HapticTool2D
## The linkage whose link is held; null for a rigid tool.
var linkage: HapticLinkage2D
## Its bodies.
var neighborhood: Neighborhood
## Conversion of this world.
var units: HapticUnits
## The newest report.
var state: PackedFloat64Array

var _world: HapticWorld2D
var _links: Array[HapticLink2D] = []
var _cursor: HapticHandCursor2D
var _is_lockstep := false
var _is_stalled := false
var _is_paused := false
var _reach := Reach.new()
var _touches: TouchSignals
var _top_speed := 0.0
var _was_full := false
var _placement := {}
var _faults: PackedStringArray = []
var _figures: StartFigures


func _init(world: HapticWorld2D) -> void:
	_world = world
	_is_lockstep = world.mode == HapticWorld2D.Mode.LOCKSTEP
	units = HapticUnits.new(world.pixels_per_meter, world.global_transform)
	neighborhood = Neighborhood.new(native, units)
	neighborhood.set_default_surface(world.default_surface)


## Sets everything up and starts the loop. Returns what is wrong.
func start() -> PackedStringArray:
	# what the world, the tool and their checks say is not said twice
	var unattended := _world.is_unattended()
	tool = _world.get_tool()
	if tool == null or _world.device == null or not PlaceChecks.can_measure(_world):
		return []
	var problems := PackedStringArray()
	var wrong := WorldSettings.problems_of(_world)
	wrong.append_array(native.configure(_world.to_settings()))
	wrong.append_array(native.set_device(_world.device.to_settings(unattended)))
	wrong.append_array(native.set_tool(_describe_tool(problems)))
	if not wrong.is_empty():
		return _of_body(wrong + problems)
	problems = native.start(not _is_lockstep, _world.record_seconds)
	if not native.is_running():
		return problems
	if not _is_lockstep:
		print("%s: %s" % [_world.name, native.get_statistics().get("scheduling_details", "")])
	native.refresh()
	state = native.get_state()
	_touches = TouchSignals.new(tool)
	_figures = StartFigures.new(_world, tool, _links)
	neighborhood.leave_out(get_parts())
	neighborhood.push_links()
	if tool is HeldBody:
		(tool as HeldBody).freeze_body()
	var limits := _world.safety if _world.safety != null else HapticSafetyLimits.new()
	_top_speed = limits.max_speed * _world.mapping_scale
	if _world.device.follows_mouse(unattended):
		_cursor = HapticHandCursor2D.new()
		_world.add_child(_cursor, false, Node.INTERNAL_MODE_BACK)
	return problems


## Ends the loop.
func stop() -> void:
	if _cursor != null:
		_cursor.queue_free()
	if _touches != null and is_instance_valid(tool):
		_touches.finish()
	neighborhood.clear()
	native.refresh()
	state = native.get_state()
	native.stop()
	if linkage != null and not _is_gone():
		linkage.place(native.get_links(), units)
	_let_go()


## One physics tick, after all else has moved. Returns what is wrong.
func tick(seconds: float) -> PackedStringArray:
	if _is_gone():
		var why := _what_is_gone()
		_world.stop()
		return ["%s, so the haptic loop was stopped. Call start(), or take() another tool." % why]
	# in lock-step the loop's time is the scene's
	var scale := 1.0 if _is_lockstep else Engine.time_scale
	if _stall(scale < _LEAST_TIME_SCALE):
		return []
	var began := Time.get_ticks_usec()
	var problems := _place()
	native.refresh()
	state = native.get_state()
	var impulses := native.take_impulses()
	problems.append_array(PlaceChecks.of(_world))
	for text: String in _figures.changed():
		push_warning("%s: %s" % [_world.get_path(), text])
	neighborhood.set_default_surface(_world.default_surface)
	units.set_frame(_world.global_transform)
	problems.append_array(
		neighborhood.publish(
			_world.get_world_2d(),
			_reach_of_tool(seconds / scale),
			_masks(),
			seconds,
			scale,
			_gravity(scale)
		)
	)
	if (neighborhood.left_out > 0) != _was_full:
		_was_full = neighborhood.left_out > 0
		if _was_full:
			_world.neighborhood_overflowed.emit(neighborhood.left_out)
	# after the snapshot: it tells of bodies that have not felt these yet
	neighborhood.give(impulses, scale)
	native.book_tick((Time.get_ticks_usec() - began) * 1e-6)
	if _is_lockstep:
		native.advance(seconds)
		show()
		# what runs beside the tool has moved as well, however many ticks a frame brings
		_world.get_tree().call_group(LinkageReader.LINKAGES, "_show_free")
	return problems


## Brings the newest report into the scene.
func show() -> void:
	native.refresh()
	state = native.get_state()
	if not _is_gone():
		if linkage != null:
			_show_linkage()
		else:
			tool.global_transform = units.pose_to_canvas(
				state[Gateway.State.TOOL_X],
				state[Gateway.State.TOOL_Y],
				state[Gateway.State.TOOL_ANGLE]
			)
		if tool is HeldBody:
			(tool as HeldBody).carry()
		var touched := neighborhood.first_numbers(native.get_touched())
		_touches.emit(
			neighborhood.of_bodies(native.take_events(), touched),
			touched,
			units,
			neighborhood.body_of
		)
	_emit_faults()


## The scene's tree pauses, or goes on.
func pause(paused: bool) -> void:
	_is_paused = paused
	_tell_pause()


## What touches now.
func get_contacts() -> Array[HapticContact]:
	var contacts: Array[HapticContact] = []
	for report: Dictionary in native.get_contacts():
		var body := neighborhood.body_of(report["body"] as int)
		contacts.append(HapticContact.from_report(report, units, body))
	return contacts


## Two numbers of the newest report as a vector on the canvas, same unit.
func vector(first: Gateway.State) -> Vector2:
	return units.vector_to_canvas(state[first], state[first + 1])


## Three numbers of it as a pose on the canvas.
func pose(first: Gateway.State) -> Transform2D:
	return units.pose_to_canvas(state[first], state[first + 1], state[first + 2])


## The convex pieces of the last snapshot, on the canvas.
func get_neighborhood() -> Array[Dictionary]:
	var pieces: Array[Dictionary] = []
	for piece: Dictionary in native.get_neighborhood():
		var flat: PackedFloat64Array = piece["points"]
		var points := PackedVector2Array()
		for i: int in range(0, flat.size() - 1, 2):
			points.append(units.point_to_canvas(flat[i], flat[i + 1]))
		if piece["half_plane"] as bool:
			points[1] = points[0] + units.vector_to_canvas(flat[2], flat[3])
		piece["points"] = points
		piece["radius"] = units.to_pixels(piece["radius"] as float)
		piece["body"] = neighborhood.body_of(piece["body"] as int)
		pieces.append(piece)
	return pieces


## Where a pointing hand wants the grip, on the canvas.
func aim(point: Vector2, angle: float) -> void:
	var at := units.point_to_meters(point)
	native.aim(at[0], at[1], units.angle_to_native(angle))


# where to look around: a disc (canvas) that the tool cannot leave before the next snapshot counts
func _reach_of_tool(tick_seconds: float) -> Array[Vector3]:
	if _world.has_meta(WorldSettings.WHOLE_SCENE):
		return [Vector3(tool.global_position.x, tool.global_position.y, _EVERYWHERE)]
	if not _is_lockstep:
		_reach.note(Time.get_ticks_usec() * 1e-6)
	if linkage != null:
		var distance := func(extent_of_link: float, speed_of_link: float) -> float:
			return _reach.distance(extent_of_link, speed_of_link, _top_speed, tick_seconds)
		return LinkageReader.reach(linkage, native.get_links(), units, distance)
	var place := units.point_to_canvas(state[Gateway.State.TOOL_X], state[Gateway.State.TOOL_Y])
	var speed := Vector2(state[Gateway.State.VELOCITY_X], state[Gateway.State.VELOCITY_Y]).length()
	# the report tells the speed of the center of mass
	var lever := units.to_meters(tool.center_of_mass.length())
	speed += absf(state[Gateway.State.VELOCITY_ANGLE]) * lever
	var extent := units.to_meters(ToolReader.extent(tool))
	var radius := units.to_pixels(_reach.distance(extent, speed, _top_speed, tick_seconds))
	return [Vector3(place.x, place.y, radius)]


# hands over what changed of mapping, clutch and turn
func _place() -> PackedStringArray:
	var wanted := WorldSettings.placement(_world)
	if wanted == _placement:
		return []
	# what is no number differs from itself, and is looked at until it is one
	var problems := WorldSettings.problems_of(_world)
	if problems.is_empty():
		_placement = wanted
		problems = native.place(wanted)
	return problems


## The hand takes another link of the linkage that is held. False, after errors that say why, when
## it cannot.
func grab(link: HapticLink2D) -> bool:
	var number := _links.find(link)
	var wrong := native.grab(number, units.local_to_meters(link.grip_point), link.hold_angle)
	for text: String in wrong:
		push_error("%s: %s" % [link.get_path(), text])
	if not wrong.is_empty():
		return false
	if _cursor != null:
		_cursor.let_go()
	return true


## The areas that the loop moves.
func get_parts() -> Array[RID]:
	var parts: Array[RID] = []
	if _is_gone():
		return parts
	if _links.is_empty():
		parts.append(tool.get_rid())
	for link: HapticLink2D in _links:
		parts.append(link.get_rid())
	return parts


func _describe_tool(problems: PackedStringArray) -> Dictionary:
	var link := tool as HapticLink2D
	linkage = link.get_linkage() if link != null else null
	if linkage == null:
		var description := ToolReader.describe(tool, units, problems)
		if tool is HeldBody:
			description["start_velocity"] = _velocity_of((tool as HeldBody).body)
		return description
	linkage.stop_free()
	_links = linkage.get_links()
	return LinkageReader.describe(linkage, link, units, problems)


func _show_linkage() -> void:
	linkage.place(native.get_links(), units)
	var held := _links[native.get_held_link()]
	if held == tool:
		return
	# contacts are the linkage's: they go on under the name of the link that is held now
	var was := tool
	_touches.finish()
	tool = held
	_touches = TouchSignals.new(tool)
	_world.tool_changed.emit(was, tool)


# also when links were added or freed: the loop's linkage is another one then
func _is_gone() -> bool:
	if not is_instance_valid(tool) or not tool.is_inside_tree():
		return true
	if tool is HeldBody and not (tool as HeldBody).is_present():
		return true
	if _links.is_empty():
		return false
	return not is_instance_valid(linkage) or linkage.get_links() != _links


func _what_is_gone() -> String:
	if is_instance_valid(linkage) and linkage.is_inside_tree():
		return "%s got, lost or moved a link while it was held" % linkage.get_path()
	return "The tool is gone"


func _masks() -> PackedInt64Array:
	var masks := PackedInt64Array()
	for link: HapticLink2D in _links:
		masks.append(link.collision_mask)
	if masks.is_empty():
		masks.append(tool.collision_mask)
	return masks


# what the native side says about a body in the hand; of tools their checks say it
func _of_body(problems: PackedStringArray) -> PackedStringArray:
	var told := PackedStringArray()
	if tool is HeldBody:
		for text: String in problems:
			told.append("%s cannot be held: %s" % [(tool as HeldBody).body.get_path(), text])
	return told


# in real time
func _velocity_of(body: RigidBody2D) -> PackedFloat64Array:
	if body.freeze:
		return PackedFloat64Array([0.0, 0.0, 0.0])
	var scale := 1.0 if _is_lockstep else Engine.time_scale
	var velocity := units.velocity_to_meters(body.linear_velocity * scale)
	velocity.append(-body.angular_velocity * scale)
	return velocity


# a body goes on as the loop had it
func _let_go() -> void:
	var held := tool as HeldBody if is_instance_valid(tool) else null
	if held == null or state.is_empty():
		return
	held.carry()
	var scale := 1.0 if _is_lockstep else maxf(Engine.time_scale, _LEAST_TIME_SCALE)
	var velocity := units.vector_to_canvas(
		state[Gateway.State.VELOCITY_X], state[Gateway.State.VELOCITY_Y]
	)
	held.give_back(
		velocity * units.pixels_per_meter / scale, -state[Gateway.State.VELOCITY_ANGLE] / scale
	)
	held.queue_free()


# pauses the output while time nearly stands; says whether it does
func _stall(stalled: bool) -> bool:
	if stalled != _is_stalled:
		_is_stalled = stalled
		_tell_pause()
	return stalled


func _tell_pause() -> void:
	native.set_paused(_is_paused or _is_stalled)


# the loop runs in real time: velocities of the scene go with its time scale, accelerations twice
func _gravity(scale: float) -> PackedFloat64Array:
	var pull := WorldSettings.pull_of(_world)
	pull[0] *= scale * scale
	pull[1] *= scale * scale
	return pull


func _emit_faults() -> void:
	if state[Gateway.State.FAULTS] == 0.0 and _faults.is_empty():
		return
	var now := native.get_faults()
	for fault: String in now:
		if not fault in _faults:
			_world.fault_raised.emit(fault)
	_faults = now
