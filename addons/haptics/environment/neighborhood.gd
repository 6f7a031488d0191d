@tool
extends RefCounted
## Keeps the native side's picture of what lies around the tool: finds the bodies, describes each
## once (and again when it changes), and hands their poses over at every physics tick.

const Gateway := preload("../nodes/gateway.gd")
const BodyReader := preload("body_reader.gd")
const FixedBody := preload("fixed_body.gd")
const KinematicBody := preload("kinematic_body.gd")
const MovableBody := preload("movable_body.gd")

# the engine cuts lists of results silently: ask again with more room when one comes back full
const _FIRST_RESULTS := 64
const _MOST_RESULTS := 4096
# what the tool may gain in speed within a tick, m/s, and what is looked around in any case, m
const _SPEED_GAIN := 0.5
const _MARGIN := 0.01

## Surface of bodies that have none.
var default_surface: HapticSurface
## Bodies in the last snapshot.
var near_count := 0

var _native: Gateway
var _units: HapticUnits
var _query := PhysicsShapeQueryParameters2D.new()
var _circle := CircleShape2D.new()
# by instance id of the node, and by number
var _readers: Dictionary[int, BodyReader] = {}
var _numbers: Dictionary[int, BodyReader] = {}
var _next_number := 1
var _most_results := _FIRST_RESULTS
var _tick := 0


func _init(native: Gateway, units: HapticUnits) -> void:
	_native = native
	_units = units
	_query.shape = _circle
	_query.collide_with_areas = false


## How far around the tool's origin to look (px): its size and how far it can get until the next
## snapshot counts, two ticks for safety.
func reach(extent: float, speed: float, tick_seconds: float) -> float:
	return extent + _units.to_pixels((speed + _SPEED_GAIN) * 2.0 * tick_seconds + _MARGIN)


## Publishes the bodies within `radius` px of `center` (canvas) that `mask` selects. Returns what
## is wrong, each with the path of its node.
func publish(
	world_2d: World2D,
	center: Vector2,
	radius: float,
	mask: int,
	tick_seconds: float,
	time_scale: float,
	gravity: PackedFloat64Array
) -> PackedStringArray:
	_tick += 1
	var problems := PackedStringArray()
	var ids := PackedInt64Array()
	var states := PackedFloat64Array()
	_circle.radius = radius
	_query.transform = Transform2D(0.0, center)
	_query.collision_mask = mask
	for reader: BodyReader in _find(world_2d.direct_space_state):
		if reader.is_dirty or (_tick + reader.id) % 60 == 0:
			_describe(reader, problems)
		if not reader.is_usable:
			continue
		var state := reader.read_state(_tick, tick_seconds)
		if reader.is_dirty:
			_describe(reader, problems)
		for i: int in range(3, 6):
			state[i] *= time_scale
		ids.append(reader.id)
		states.append_array(state)
	near_count = ids.size()
	problems.append_array(
		_native.submit(ids, states, clampf(tick_seconds / time_scale, 0.001, 1.0), gravity)
	)
	return problems


## Gives bodies what the tool pushed them with: id, x, y, angular each.
func give(impulses: PackedFloat64Array, time_scale: float) -> void:
	for i: int in range(0, impulses.size() - 3, 4):
		var reader: BodyReader = _numbers.get(int(impulses[i]))
		if reader != null:
			reader.take_impulse(impulses[i + 1], impulses[i + 2], impulses[i + 3], time_scale)


## The node with that number, null when it is gone.
func body_of(number: int) -> CollisionObject2D:
	var reader: BodyReader = _numbers.get(number)
	return reader.node if reader != null else null


## Forgets everything.
func clear() -> void:
	for reader: BodyReader in _readers.values().duplicate():
		_forget(reader)


func _find(space: PhysicsDirectSpaceState2D) -> Array[BodyReader]:
	var results := space.intersect_shape(_query, _most_results)
	while results.size() >= _most_results and _most_results < _MOST_RESULTS:
		_most_results *= 2
		results = space.intersect_shape(_query, _most_results)
	var found: Dictionary[int, BodyReader] = {}
	for result: Dictionary in results:
		var body := result["collider"] as CollisionObject2D
		if body == null:
			continue
		var reader := _reader_of(body)
		found[reader.id] = reader
	var ids := found.keys()
	# the same order in every run
	ids.sort()
	var readers: Array[BodyReader] = []
	for id: int in ids:
		readers.append(found[id])
	return readers


func _reader_of(body: CollisionObject2D) -> BodyReader:
	var key := body.get_instance_id()
	var reader: BodyReader = _readers.get(key)
	if reader != null:
		return reader
	if body is RigidBody2D:
		reader = MovableBody.new(body, _next_number, _units)
	elif body is AnimatableBody2D or not body is StaticBody2D:
		reader = KinematicBody.new(body, _next_number, _units)
	else:
		reader = FixedBody.new(body, _next_number, _units)
	_next_number += 1
	_readers[key] = reader
	_numbers[reader.id] = reader
	body.tree_exiting.connect(_forget.bind(reader), CONNECT_ONE_SHOT)
	_watch(reader)
	return reader


func _describe(reader: BodyReader, problems: PackedStringArray) -> void:
	reader.is_dirty = false
	var description := reader.describe(default_surface)
	var signature := description.hash()
	if signature == reader.signature:
		return
	reader.signature = signature
	var wrong := reader.problems + _native.set_body(reader.id, description)
	reader.is_usable = _native.is_valid() and wrong.size() == reader.problems.size()
	_watch(reader)
	# our own nodes report themselves
	if reader.node is HapticWall2D or reader.node is HapticObject2D:
		return
	for text: String in wrong:
		problems.append("%s: %s" % [reader.node.get_path(), text])


# changes of shapes and surfaces count at the next tick
func _watch(reader: BodyReader) -> void:
	var parts: Array[Resource] = [BodyReader.SurfaceReader.find(reader.node, default_surface)]
	for owner_id: int in reader.node.get_shape_owners():
		for index: int in reader.node.shape_owner_get_shape_count(owner_id):
			parts.append(reader.node.shape_owner_get_shape(owner_id, index))
	for part: Resource in parts:
		if not part.changed.is_connected(_mark.bind(reader.id)):
			part.changed.connect(_mark.bind(reader.id))


func _mark(number: int) -> void:
	var reader: BodyReader = _numbers.get(number)
	if reader != null:
		reader.is_dirty = true


func _forget(reader: BodyReader) -> void:
	_readers.erase(reader.node.get_instance_id())
	_numbers.erase(reader.id)
	if reader.node.tree_exiting.is_connected(_forget):
		reader.node.tree_exiting.disconnect(_forget)
	_native.remove_body(reader.id)
