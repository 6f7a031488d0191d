@tool
extends RefCounted
## Finds the bodies around the tool by the engine's broad phase, and gives each a reader and a
## number that stay as long as the body.

const BodyReader := preload("body_reader.gd")
const FixedBody := preload("fixed_body.gd")
const LinkBody := preload("link_body.gd")
const KinematicBody := preload("kinematic_body.gd")
const MovableBody := preload("movable_body.gd")
const TileBody := preload("tile_body.gd")
const TileLayer := preload("tile_layer.gd")

# the engine cuts lists of results silently: ask again with more room when one comes back full
const _FIRST_RESULTS := 64
const _MOST_RESULTS := 4096
# a body that the engine no longer finds, though nothing says why, is kept for so many ticks
const _GRACE := 2
# earlier numbers of a body that are remembered, while what it was then fades
const _MOST_NUMBERS := 32

var _units: HapticUnits
# takes a number back on the native side
var _remove: Callable
var _query := PhysicsShapeQueryParameters2D.new()
var _circle := CircleShape2D.new()
# by instance id of the node, and by number
var _readers: Dictionary[int, BodyReader] = {}
var _layers: Dictionary[int, TileLayer] = {}
var _numbers: Dictionary[int, BodyReader] = {}
# left the tree since the last look; some come back at once, under another parent
var _leaving: Dictionary[int, bool] = {}
var _next_number := 1
var _pushes_links := false
var _most_results := _FIRST_RESULTS
var _problems := PackedStringArray()
# what was answered last, and the readers of that
var _last_keys := PackedInt64Array()
var _last: Array[BodyReader] = []
var _misses_some := false


func _init(units: HapticUnits, remove: Callable) -> void:
	_units = units
	_remove = remove
	_query.shape = _circle
	# tools and links that nobody holds are areas; other areas are no matter
	_query.collide_with_areas = true


## The bodies within the discs (canvas: x, y, radius in px) that `mask` or `more` selects, in the
## order in which they were met first: the same in every run. Of tiles those that `mask` selects.
func find(
	space: PhysicsDirectSpaceState2D, discs: Array[Vector3], mask: int, more: int
) -> Array[BodyReader]:
	_query.collision_mask = mask | more
	var keys := PackedInt64Array()
	var answers: Array[Array] = []
	for disc: Vector3 in discs:
		_circle.radius = disc.z
		_query.transform = Transform2D(0.0, Vector2(disc.x, disc.y))
		var results := _ask(space)
		answers.append(results)
		for result: Dictionary in results:
			keys.append(result["collider_id"])
	# mostly the same as at the tick before; tiles come and go within their layer
	if keys != _last_keys or _misses_some or not _layers.is_empty():
		_last_keys = keys
		var found := _sort_out(answers, discs, mask)
		_keep_missing(found, space, mask | more)
		_last.clear()
		for id: int in _sorted(found):
			_last.append(found[id])
	return _last


# The engine finds a body whose shapes were set anew only after its next step.
func _keep_missing(
	found: Dictionary[int, BodyReader], space: PhysicsDirectSpaceState2D, mask: int
) -> void:
	_misses_some = false
	for id: int in found:
		found[id].missed = 0
	for reader: BodyReader in _last:
		if found.has(reader.id) or not reader.is_present():
			continue
		var body := reader.node as CollisionObject2D
		if body == null or body.collision_layer & mask == 0 or reader.is_switched_off():
			continue
		if body.get_world_2d().direct_space_state != space:
			continue
		reader.look()
		reader.missed = 0 if reader.is_dirty else reader.missed + 1
		if reader.missed <= _GRACE:
			_misses_some = true
			found[reader.id] = reader


func _sorted(found: Dictionary[int, BodyReader]) -> Array[int]:
	var ids := found.keys()
	ids.sort()
	return ids


# the readers of what was answered, by their numbers
func _sort_out(
	answers: Array[Array], discs: Array[Vector3], mask: int
) -> Dictionary[int, BodyReader]:
	var found: Dictionary[int, BodyReader] = {}
	for index: int in discs.size():
		var disc := discs[index]
		var seen: Dictionary[int, bool] = {}
		for result: Dictionary in answers[index]:
			var key: int = result["collider_id"]
			if seen.has(key) or _is_no_matter(result["collider"]):
				continue
			seen[key] = true
			var reader: BodyReader = _readers.get(key)
			if reader != null:
				found[reader.id] = reader
			else:
				_meet(result["collider"], disc, mask, found)
	return found


## Gives a body a new number: what it was leaves, what it is appears. Both fade where they are
## touched.
func renumber(reader: BodyReader) -> void:
	_remove.call(reader.id)
	reader.numbers.append(reader.id)
	if reader.numbers.size() > _MOST_NUMBERS:
		_numbers.erase(reader.numbers[1])
		reader.numbers.remove_at(1)
	reader.id = _next_number
	_next_number += 1
	_numbers[reader.id] = reader
	_last_keys.clear()


## Never finds these.
func leave_out(parts: Array[RID]) -> void:
	_query.exclude = parts


## Links are pushed from now on.
func push_links() -> void:
	_pushes_links = true


## The reader with that number, null when it is gone.
func reader_of(number: int) -> BodyReader:
	return _numbers.get(number)


## All that are known, each once or more often.
func readers() -> Array[BodyReader]:
	return _numbers.values()


## Takes the numbers of bodies back that left the scene for good.
func forget_gone() -> void:
	for key: int in _leaving:
		var reader: BodyReader = _readers.get(key)
		if reader != null and not reader.is_present():
			_drop(reader)
			_readers.erase(key)
		var layer: TileLayer = _layers.get(key)
		if layer != null and not (is_instance_valid(layer.node) and layer.node.is_inside_tree()):
			for body: TileBody in layer.bodies():
				_drop(body)
			_layers.erase(key)
	_leaving.clear()


## What cannot be touched, each with the path of its node, since the last call.
func take_problems() -> PackedStringArray:
	var told := _problems
	_problems = PackedStringArray()
	return told


## Forgets everything.
func clear() -> void:
	for number: int in _numbers.keys():
		# one body may have several
		if _numbers.has(number):
			_drop(_numbers[number])
	_readers.clear()
	_layers.clear()
	_leaving.clear()


func _is_no_matter(collider: Object) -> bool:
	return collider is Area2D and not collider is HapticTool2D


func _ask(space: PhysicsDirectSpaceState2D) -> Array[Dictionary]:
	var results := space.intersect_shape(_query, _most_results)
	while results.size() >= _most_results and _most_results < _MOST_RESULTS:
		_most_results *= 2
		results = space.intersect_shape(_query, _most_results)
	return results


func _meet(collider: Object, disc: Vector3, mask: int, found: Dictionary[int, BodyReader]) -> void:
	if collider is TileMapLayer:
		var layer := _layer_of(collider as TileMapLayer)
		for body: BodyReader in layer.find_near(
			Vector2(disc.x, disc.y), disc.z, mask, _adopt_tiles, _drop
		):
			found[body.id] = body
	elif collider is CollisionObject2D:
		var reader := _make(collider as CollisionObject2D)
		found[reader.id] = reader
	elif collider is Node:
		(
			_problems
			. append(
				(
					"%s: a %s cannot be touched. Use TileMapLayers for tiles, and bodies for everything else."
					% [(collider as Node).get_path(), collider.get_class()]
				)
			)
		)


func _make(body: CollisionObject2D) -> BodyReader:
	var reader: BodyReader
	if body is RigidBody2D:
		reader = MovableBody.new(body, _next_number, _units)
	elif body is HapticLink2D and _pushes_links:
		reader = LinkBody.new(body, _next_number, _units)
	elif body is AnimatableBody2D or not body is StaticBody2D:
		reader = KinematicBody.new(body, _next_number, _units)
	else:
		reader = FixedBody.new(body, _next_number, _units)
	_next_number += 1
	_readers[body.get_instance_id()] = reader
	_numbers[reader.id] = reader
	_follow(body)
	return reader


func _layer_of(node: TileMapLayer) -> TileLayer:
	var key := node.get_instance_id()
	if not _layers.has(key):
		_layers[key] = TileLayer.new(node)
		_follow(node)
	return _layers[key]


func _adopt_tiles(node: TileMapLayer) -> TileBody:
	var body := TileBody.new(node, _next_number, _units)
	_next_number += 1
	_numbers[body.id] = body
	return body


func _follow(node: Node) -> void:
	var key := node.get_instance_id()
	if not node.tree_exiting.is_connected(_on_leaving):
		node.tree_exiting.connect(_on_leaving.bind(key))


func _on_leaving(key: int) -> void:
	_leaving[key] = true


func _drop(reader: BodyReader) -> void:
	_last_keys.clear()
	_last = []
	_numbers.erase(reader.id)
	for number: int in reader.numbers:
		_numbers.erase(number)
	if is_instance_valid(reader.node) and reader.node.tree_exiting.is_connected(_on_leaving):
		if not reader is TileBody:
			reader.node.tree_exiting.disconnect(_on_leaving)
	_remove.call(reader.id)
