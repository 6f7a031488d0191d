@tool
extends RefCounted
## Keeps the native side's picture of what lies around the tool: finds the bodies, describes each
## once (and again when it changes), and hands their poses over at every physics tick.

const Gateway := preload("../nodes/gateway.gd")
const BodyFinder := preload("body_finder.gd")
const BodyReader := preload("body_reader.gd")
const Reach := preload("reach.gd")

# what has no signal is looked for in so many ticks, in what is touched at every tick
const _TICKS_TO_LOOK := 8
# and everything is described anew in so many, whatever was noticed
const _TICKS_TO_DESCRIBE := 240
# bodies that can be pushed, beyond those in reach of the tool only so many that the loop has room
const _MOST_MOVABLES := 16
# around those beyond reach, m: they hardly move until the next look
const _NARROW := 0.002
# of our own nodes
const _TELL := &"tell_problems"

## Surface of bodies that have none; see set_default_surface().
var default_surface: HapticSurface
## Bodies in the last snapshot.
var near_count := 0
## Convex pieces within reach that did not fit into it.
var left_out := 0
## Where was looked around last, canvas: x, y, radius (px).
var discs: Array[Vector3] = []

var _native: Gateway
var _units: HapticUnits
var _finder: BodyFinder
# numbers of bodies that are made of a resource, by its instance id
var _watchers: Dictionary[int, Dictionary] = {}
var _tick := 0
# discs around what can be pushed, from the last snapshot, and what these bodies meet
var _around_movables: Array[Vector3] = []
var _met_by_movables := 0


func _init(native: Gateway, units: HapticUnits) -> void:
	_native = native
	_units = units
	_finder = BodyFinder.new(units, _native.remove_body)


## Publishes what lies within the discs (canvas: x, y, radius in px) and what `masks` select, of a
## linkage those of each link. Returns what is wrong, each with the path of its node.
func publish(
	world_2d: World2D,
	around: Array[Vector3],
	masks: PackedInt64Array,
	tick_seconds: float,
	time_scale: float,
	gravity: PackedFloat64Array
) -> PackedStringArray:
	_tick += 1
	_finder.forget_gone()
	var problems := PackedStringArray()
	var ids := PackedInt64Array()
	var states := PackedFloat64Array()
	var touched := _native.get_touched()
	discs = around.duplicate()
	var mask := 0
	for bits: int in masks:
		mask |= bits
	var readers := _finder.find(
		world_2d.direct_space_state, around + _around_movables, mask, _met_by_movables
	)
	for reader: BodyReader in readers:
		var turn := _tick + reader.id
		if reader.is_dirty or turn % _TICKS_TO_LOOK == 0 or reader.id in touched:
			reader.look()
			if reader.is_dirty or turn % _TICKS_TO_DESCRIBE == 0:
				_describe(reader, problems)
	var beyond := _surround_movables(readers)
	for reader: BodyReader in readers:
		if not reader.is_usable or beyond.has(reader.id):
			continue
		var state := reader.read_state(_tick, tick_seconds)
		if reader.is_dirty:
			_describe(reader, problems)
		reader.tie(_native)
		ids.append(reader.id)
		states.append_array(state)
	if time_scale != 1.0:
		for i: int in states.size():
			var place := i % 8
			if place > 2:
				states[i] *= time_scale if place < 6 else time_scale * time_scale
	near_count = ids.size()
	problems.append_array(_finder.take_problems())
	for text: String in _native.submit(
		ids,
		states,
		clampf(tick_seconds / time_scale, 0.001, 1.0),
		gravity,
		_to_meters(discs),
		masks
	):
		problems.append(_named(text))
	left_out = _native.get_left_out()
	return problems


## The surface of bodies that have none, from the next snapshot on.
func set_default_surface(surface: HapticSurface) -> void:
	if surface == default_surface:
		return
	default_surface = surface
	for reader: BodyReader in _finder.readers():
		reader.is_dirty = true


## Gives bodies what the tool pushed them with: id, x, y, angular each.
func give(impulses: PackedFloat64Array, time_scale: float) -> void:
	for i: int in range(0, impulses.size() - 3, 4):
		var reader := _finder.reader_of(int(impulses[i]))
		if reader != null and reader.is_present():
			reader.take_impulse(impulses[i + 1], impulses[i + 2], impulses[i + 3], time_scale)


## Links of linkages that run beside the tool are pushed; else they are taken for bodies that do not
## yield.
func push_links() -> void:
	_finder.push_links()


## Areas that are no neighbors: the parts of the tool itself.
func leave_out(parts: Array[RID]) -> void:
	_finder.leave_out(parts)


## The node with that number, null when it is gone.
func body_of(number: int) -> Node2D:
	var reader := _finder.reader_of(number)
	return reader.node if reader != null and is_instance_valid(reader.node) else null


## These events under the first number of each body, but those of a body that is still touched under
## another number. `touched` are first numbers.
func of_bodies(events: Array, touched: PackedInt64Array) -> Array:
	var told: Array = []
	for event: Dictionary in events:
		var number: int = event["body"]
		var reader := _finder.reader_of(number)
		if reader != null:
			event["body"] = reader.first_number()
			if event["kind"] == "ended" and number != reader.id and event["body"] in touched:
				continue
		told.append(event)
	return told


## The first numbers of these bodies, each once.
func first_numbers(numbers: PackedInt64Array) -> PackedInt64Array:
	var first := PackedInt64Array()
	for number: int in numbers:
		var reader := _finder.reader_of(number)
		var known := reader.first_number() if reader != null else number
		if not known in first:
			first.append(known)
	return first


## The surface of what has that number; null when it is gone.
func surface_of(number: int) -> HapticSurface:
	var reader := _finder.reader_of(number)
	if reader == null or not reader.is_present():
		return null
	return reader.surface(default_surface)


## Forgets everything.
func clear() -> void:
	_finder.clear()
	_watchers.clear()
	_around_movables.clear()


# A body that can be pushed meets what lies around it, and what it rests on may rest on others: each
# gets a disc, from the tool on, as long as the loop has room, and at the next tick there is looked
# for bodies in them. Returns the numbers of bodies that can be pushed and have none.
func _surround_movables(readers: Array[BodyReader]) -> Dictionary[int, bool]:
	var left: Dictionary[int, bool] = {}
	var movables: Array[BodyReader] = []
	for reader: BodyReader in readers:
		if reader.kind() == "movable" and is_finite(reader.extent):
			left[reader.id] = true
			movables.append(reader)
	var tool_discs := discs.size()
	_around_movables.clear()
	_met_by_movables = 0
	var from := 0
	while from < discs.size() and not left.is_empty():
		var disc := discs[from]
		from += 1
		for reader: BodyReader in movables:
			if not left.has(reader.id):
				continue
			var is_near := from <= tool_discs
			if not is_near and _around_movables.size() >= _MOST_MOVABLES:
				break
			var radius := _units.to_pixels(reader.extent + (Reach.MARGIN if is_near else _NARROW))
			var at := reader.node.global_position
			if at.distance_to(Vector2(disc.x, disc.y)) > disc.z + radius:
				continue
			left.erase(reader.id)
			_met_by_movables |= (reader.node as CollisionObject2D).collision_mask
			_around_movables.append(Vector3(at.x, at.y, radius))
			discs.append(_around_movables[-1])
	return left


func _to_meters(around: Array[Vector3]) -> PackedFloat64Array:
	var flat := PackedFloat64Array()
	for disc: Vector3 in around:
		flat.append_array(_units.point_to_meters(Vector2(disc.x, disc.y)))
		flat.append(_units.to_meters(disc.z))
	return flat


# the native side knows bodies by their number
func _named(text: String) -> String:
	var number := text.get_slice(" ", 1)
	var body := body_of(number.to_int()) if text.begins_with("Body ") else null
	if body == null or not body.is_inside_tree():
		return text
	return str(body.get_path()) + text.trim_prefix("Body " + number)


func _describe(reader: BodyReader, problems: PackedStringArray) -> void:
	reader.is_dirty = false
	var description := reader.describe(default_surface)
	_watch(reader)
	var signature := description.hash()
	if signature == reader.signature:
		return
	reader.signature = signature
	var shapes: Array[Dictionary] = description["shapes"]
	if reader.exchanges_shapes(shapes) and description["kind"] != "movable":
		_finder.renumber(reader)
	if reader.is_switched_off():
		reader.is_usable = false
		return
	var wrong := reader.problems + _native.set_body(reader.id, description)
	reader.is_usable = _native.is_valid() and wrong.size() == reader.problems.size()
	# our own nodes report themselves, each once
	if reader.node.has_method(_TELL):
		if wrong.size() > 0:
			reader.node.call(_TELL)
		return
	for text: String in wrong:
		problems.append("%s: %s" % [reader.node.get_path(), text])


# changes inside of shapes and surfaces count at the next tick
func _watch(reader: BodyReader) -> void:
	for part: Resource in reader.parts(default_surface):
		var key := part.get_instance_id()
		if not _watchers.has(key):
			_watchers[key] = {}
			# one connection for all bodies that share it: the engine takes no second one
			part.changed.connect(_mark.bind(key))
		_watchers[key][reader.id] = true


func _mark(part: int) -> void:
	for number: int in _watchers.get(part, {}):
		var reader := _finder.reader_of(number)
		if reader != null:
			reader.is_dirty = true
