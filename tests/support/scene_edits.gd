extends RefCounted
## Random changes of a scene near its tool, of every kind that a game makes while it runs.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Tiles := preload("res://tests/support/tiles.gd")
const Linkages := preload("res://tests/support/linkages.gd")
const Outlines := preload("res://tests/support/outlines.gd")

const _MOST_BODIES := 12
const _MOST_LINKAGES := 2

## How often each kind of change was made, by its name.
var made: Dictionary[String, int] = {}

var _scene: Node2D
var _tool: HapticTool2D
var _random: RandomNumberGenerator
var _bodies: Array[CollisionObject2D] = []
var _linkages: Array[HapticLinkage2D] = []
var _parents: Array[Node2D] = []
var _surfaces: Array[HapticSurface] = []
var _shared: Array[Shape2D] = []
var _packed: Array[PackedScene] = []
var _layer: TileMapLayer
var _kinds: Array[Callable] = [
	_add,
	_add,
	_add,
	_free,
	_queue_free,
	_move_to_another_parent,
	_take_out_and_in,
	_shift,
	_turn,
	_scale,
	_exchange_shape,
	_change_shape,
	_share_shape,
	_add_shape,
	_add_outline,
	_change_outline,
	_change_outline,
	_remove_shape,
	_switch_shape,
	_switch_one_way,
	_change_layers,
	_change_mask,
	_exchange_surface,
	_change_surface,
	_push,
	_freeze,
	_change_mass,
	_set_cell,
	_exchange_layer,
	_instantiate,
	_instantiate,
	_exchange_instance,
	_add_linkage,
	_free_linkage,
	_change_linkage,
	_move_parent,
]


## `scene` holds the world; all goes into it. Nothing of what `tool` is changes but its mask.
func _init(scene: Node2D, tool: HapticTool2D, random: RandomNumberGenerator) -> void:
	_scene = scene
	_tool = tool
	_random = random
	for i: int in 3:
		var parent := Node2D.new()
		parent.position = Vector2(10, 5) * i
		_scene.add_child(parent)
		_parents.append(parent)
		var surface := HapticSurface.new()
		surface.stiffness = 3000.0 + 4000.0 * i
		surface.static_friction = 0.2 * i
		surface.dynamic_friction = 0.15 * i
		_surfaces.append(surface)
		_shared.append(_shape())
	_packed.append(_pack(Scene.make_wall(Vector2.ZERO, Vector2(60, 20))))
	_packed.append(_pack(Scene.make_object(Vector2.ZERO, Vector2(30, 20), 0.1)))
	_add_layer()


## One change.
func edit() -> void:
	var kind := _kinds[_random.randi_range(0, _kinds.size() - 1)]
	kind.call()
	var called := kind.get_method().trim_prefix("_")
	made[called] = made.get(called, 0) + 1


## Takes everything out again.
func free_all() -> void:
	for body: CollisionObject2D in _bodies:
		body.free()
	_bodies.clear()
	for linkage: HapticLinkage2D in _linkages:
		linkage.free()
	_linkages.clear()
	_layer.free()


func _pack(body: CollisionObject2D) -> PackedScene:
	for child: Node in body.get_children():
		child.owner = body
	var packed := PackedScene.new()
	packed.pack(body)
	body.free()
	return packed


# null when there is none
func _pick() -> CollisionObject2D:
	if _bodies.is_empty():
		return null
	return _bodies[_random.randi_range(0, _bodies.size() - 1)]


# a random CollisionShape2D or CollisionPolygon2D of a random body; null when there is none
func _pick_holder() -> Node2D:
	var body := _pick()
	if body == null or body.get_child_count() == 0:
		return null
	var index := _random.randi_range(0, body.get_child_count() - 1)
	return body.get_child(index) as Node2D


func _pick_shape() -> CollisionShape2D:
	return _pick_holder() as CollisionShape2D


func _at(spread: float) -> Vector2:
	var x := _random.randf_range(-spread, spread)
	return Vector2(x, _random.randf_range(-spread, spread))


func _surface() -> HapticSurface:
	return _surfaces[_random.randi_range(0, _surfaces.size() - 1)]


func _parent() -> Node2D:
	return _parents[_random.randi_range(0, _parents.size() - 1)]


func _shape() -> Shape2D:
	match _random.randi_range(0, 5):
		0:
			var circle := CircleShape2D.new()
			circle.radius = _random.randf_range(5.0, 25.0)
			return circle
		1:
			var capsule := CapsuleShape2D.new()
			capsule.radius = _random.randf_range(4.0, 10.0)
			capsule.height = _random.randf_range(25.0, 60.0)
			return capsule
		2:
			var segment := SegmentShape2D.new()
			segment.a = _at(40.0)
			segment.b = segment.a + Vector2(_random.randf_range(5.0, 60.0), 3.0)
			return segment
		3:
			var convex := ConvexPolygonShape2D.new()
			var points := PackedVector2Array()
			for i: int in _random.randi_range(3, 8):
				points.append(_at(30.0))
			convex.set_point_cloud(points)
			return convex
		4:
			return Outlines.make_segments(_random)
	var box := RectangleShape2D.new()
	var width := _random.randf_range(5.0, 60.0)
	box.size = Vector2(width, _random.randf_range(5.0, 30.0))
	return box


func _add_layer() -> void:
	_layer = Tiles.make_layer(Tiles.make_set(_surfaces[0]), Rect2i(-6, 6, 12, 1))
	_scene.add_child(_layer)


func _add() -> void:
	if _bodies.size() >= _MOST_BODIES:
		return
	var body: CollisionObject2D
	match _random.randi_range(0, 6):
		0:
			body = StaticBody2D.new()
		1:
			body = AnimatableBody2D.new()
		2:
			body = CharacterBody2D.new()
		3:
			body = HapticWall2D.new()
		4:
			body = HapticObject2D.new()
		5:
			body = Area2D.new()
		6:
			body = RigidBody2D.new()
			(body as RigidBody2D).gravity_scale = 0.0
	body.add_child(_holder())
	body.position = Vector2(0, 40) + _at(60.0)
	_parent().add_child(body)
	_bodies.append(body)


func _holder() -> CollisionShape2D:
	var holder := CollisionShape2D.new()
	holder.shape = _shape()
	return holder


func _free() -> void:
	var body := _pick()
	if body != null:
		_bodies.erase(body)
		body.free()


func _queue_free() -> void:
	var body := _pick()
	if body != null:
		_bodies.erase(body)
		body.queue_free()


func _move_to_another_parent() -> void:
	var body := _pick()
	if body != null:
		body.reparent(_parent(), _random.randf() < 0.5)


func _take_out_and_in() -> void:
	var body := _pick()
	if body != null:
		body.get_parent().remove_child(body)
		_parent().add_child(body)


func _shift() -> void:
	var body := _pick()
	if body != null:
		body.position += _at(10.0)


func _turn() -> void:
	var body := _pick()
	if body != null:
		body.rotation += _random.randf_range(-0.3, 0.3)


func _scale() -> void:
	var body := _pick()
	if body != null and not body is RigidBody2D:
		# uneven or mirrored circles are an error of the engine's own
		body.scale = Vector2.ONE * _random.randf_range(0.5, 1.5)


func _exchange_shape() -> void:
	var holder := _pick_shape()
	if holder != null:
		holder.shape = _shape()


func _change_shape() -> void:
	var holder := _pick_shape()
	if holder == null:
		return
	if holder.shape is RectangleShape2D:
		(holder.shape as RectangleShape2D).size *= _random.randf_range(0.8, 1.25)
	elif holder.shape is CircleShape2D:
		(holder.shape as CircleShape2D).radius *= _random.randf_range(0.8, 1.25)
	else:
		holder.position += _at(5.0)


func _share_shape() -> void:
	var holder := _pick_shape()
	if holder != null:
		holder.shape = _shared[_random.randi_range(0, _shared.size() - 1)]


func _add_shape() -> void:
	var body := _pick()
	if body != null and body.get_child_count() < 4:
		body.add_child(_holder())


func _add_outline() -> void:
	var body := _pick()
	if body != null and body.get_child_count() < 4:
		body.add_child(Outlines.make(_random))


func _change_outline() -> void:
	var holder := _pick_holder()
	if holder is CollisionPolygon2D:
		Outlines.change(holder as CollisionPolygon2D, _random)
	elif holder != null and (holder as CollisionShape2D).shape is ConcavePolygonShape2D:
		var concave := (holder as CollisionShape2D).shape as ConcavePolygonShape2D
		concave.segments = Outlines.make_segments(_random).segments


func _remove_shape() -> void:
	var holder := _pick_holder()
	if holder != null and holder.get_parent().get_child_count() > 1:
		holder.free()


func _switch_shape() -> void:
	var holder := _pick_holder()
	if holder != null:
		holder.set(&"disabled", not (holder.get(&"disabled") as bool))


func _switch_one_way() -> void:
	var holder := _pick_holder()
	if holder != null and not holder.get_parent() is Area2D:
		holder.set(&"one_way_collision", not (holder.get(&"one_way_collision") as bool))


func _change_layers() -> void:
	var body := _pick()
	if body != null:
		body.collision_layer = _random.randi_range(0, 3)


func _change_mask() -> void:
	_tool.collision_mask = 1 if _random.randf() < 0.8 else _random.randi_range(0, 3)


func _exchange_surface() -> void:
	var body := _pick()
	if body is HapticWall2D:
		(body as HapticWall2D).surface = _surface() if _random.randf() < 0.8 else null
	elif body != null:
		body.set_meta(&"haptic_surface", _surface())


func _change_surface() -> void:
	_surface().stiffness = _random.randf_range(1000.0, 15000.0)


func _push() -> void:
	var body := _pick() as RigidBody2D
	if body != null:
		body.linear_velocity = _at(200.0)
		body.angular_velocity = _random.randf_range(-2.0, 2.0)


func _freeze() -> void:
	var body := _pick() as RigidBody2D
	if body != null:
		body.freeze = not body.freeze
		body.freeze_mode = (
			RigidBody2D.FREEZE_MODE_STATIC
			if _random.randf() < 0.5
			else RigidBody2D.FREEZE_MODE_KINEMATIC
		)


func _change_mass() -> void:
	var body := _pick() as RigidBody2D
	if body != null:
		body.mass = _random.randf_range(0.01, 2.0)
		body.lock_rotation = _random.randf() < 0.3


func _set_cell() -> void:
	var cell := Vector2i(_random.randi_range(-6, 6), 0)
	cell.y = _random.randi_range(5, 7)
	var source := 0 if _random.randf() < 0.5 else -1
	_layer.set_cell(cell, source, Tiles.ONE_WAY if _random.randf() < 0.3 else Tiles.WHOLE)


func _exchange_layer() -> void:
	if _random.randf() < 0.2:
		_layer.queue_free()
		_add_layer()


func _instantiate() -> void:
	if _bodies.size() >= _MOST_BODIES:
		return
	var packed := _packed[_random.randi_range(0, _packed.size() - 1)]
	var body := packed.instantiate() as CollisionObject2D
	body.position = Vector2(0, 40) + _at(60.0)
	_parent().add_child(body)
	_bodies.append(body)


# as a game exchanges a whole piece of its level: the new one comes before the old one goes
func _exchange_instance() -> void:
	var body := _pick()
	if body == null:
		return
	var at := body.global_position
	_bodies.erase(body)
	_instantiate()
	if not _bodies.is_empty():
		_bodies[-1].global_position = at
	body.queue_free()


func _add_linkage() -> void:
	if _linkages.size() >= _MOST_LINKAGES:
		return
	var linkage := Linkages.make_chain(_random.randi_range(1, 3), Vector2(60, 12))
	linkage.position = Vector2(-60, 30) + _at(30.0)
	linkage.grounded = _random.randf() < 0.7
	_scene.add_child(linkage)
	_linkages.append(linkage)


func _free_linkage() -> void:
	if _linkages.is_empty() or _random.randf() < 0.5:
		return
	var linkage := _linkages[_random.randi_range(0, _linkages.size() - 1)]
	_linkages.erase(linkage)
	linkage.queue_free()


func _change_linkage() -> void:
	if _linkages.is_empty():
		return
	var linkage := _linkages[_random.randi_range(0, _linkages.size() - 1)]
	var links := linkage.get_links()
	if links.is_empty():
		return
	var link := links[_random.randi_range(0, links.size() - 1)]
	match _random.randi_range(0, 4):
		0:
			if links.size() > 1:
				links[-1].queue_free()
		1:
			link.mass = _random.randf_range(0.02, 0.5)
		2:
			linkage.moves_freely = not linkage.moves_freely
		3:
			link.collision_layer = _random.randi_range(0, 1)
		4:
			if links.size() < 4:
				links[-1].add_child(Linkages.make_link("More", Vector2(40, 10)))


func _move_parent() -> void:
	_parent().position += _at(4.0)
