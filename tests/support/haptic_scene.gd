extends RefCounted
## Small haptic scenes built in code, shared by the suites.

# scene seconds in a second of the wall's clock; a power of two leaves the tick's length exact
const _HURRY := 8


## Lets lock-step scenes run faster than time, tick for tick the same. For before_all.
static func hurry() -> void:
	Engine.physics_ticks_per_second = 60 * _HURRY
	Engine.max_physics_steps_per_frame = 64
	Engine.time_scale = _HURRY


## Takes that back. For after_all.
static func calm_down() -> void:
	Engine.physics_ticks_per_second = 60
	Engine.max_physics_steps_per_frame = 8
	Engine.time_scale = 1.0


## A world in lock-step, held by a hand that pushes with `force` (N, y down) from `start_time` on.
static func make_world(force: Vector2 = Vector2.ZERO, start_time: float = 0.7) -> HapticWorld2D:
	var hand := HapticSimulatedHand.new()
	hand.kind = HapticSimulatedHand.Kind.CONSTANT_FORCE
	hand.mass = 0.0
	hand.inertia = 0.0
	hand.force = force
	hand.start_time = start_time
	var device := HapticSimulatedPantograph.new()
	device.hand = hand
	device.encoder_model = HapticSimulatedPantograph.EncoderModel.EXACT
	device.measures_force = true
	var world := HapticWorld2D.new()
	world.name = "World"
	world.device = device
	world.mode = HapticWorld2D.Mode.LOCKSTEP
	return world


## A hand that follows a path: rows of t (s), x, y (m, y down), angle (rad).
static func make_path(rows: Array[PackedFloat64Array]) -> HapticSimulatedHand:
	var hand := HapticSimulatedHand.new()
	hand.kind = HapticSimulatedHand.Kind.RECORDED_PATH
	hand.stiffness = 1000.0
	for row: PackedFloat64Array in rows:
		hand.path_times.append(row[0])
		hand.path.append(Vector3(row[1], row[2], row[3]))
	return hand


## A box of `size` px at `position`.
static func make_tool(
	position: Vector2 = Vector2.ZERO, size: Vector2 = Vector2(160, 80)
) -> HapticTool2D:
	var tool := HapticTool2D.new()
	tool.name = "Tool"
	tool.position = position
	tool.mass = 0.3
	tool.add_child(make_box(size))
	return tool


## A wall of `size` px at `position`, with the paper's surface.
static func make_wall(position: Vector2, size: Vector2) -> HapticWall2D:
	var wall := HapticWall2D.new()
	wall.name = "Wall"
	wall.position = position
	wall.surface = HapticSurface.new()
	wall.add_child(make_box(size))
	return wall


## An object of `size` px at `position` that slides without friction.
static func make_object(position: Vector2, size: Vector2, mass: float) -> HapticObject2D:
	var object := HapticObject2D.new()
	object.name = "Object"
	object.position = position
	object.mass = mass
	object.gravity_scale = 0.0
	object.linear_damp_mode = RigidBody2D.DAMP_MODE_REPLACE
	object.angular_damp_mode = RigidBody2D.DAMP_MODE_REPLACE
	object.linear_damp = 0.0
	object.angular_damp = 0.0
	object.surface = HapticSurface.new()
	object.add_child(make_box(size))
	return object


## A rectangular shape.
static func make_box(size: Vector2, position: Vector2 = Vector2.ZERO) -> CollisionShape2D:
	var shape := CollisionShape2D.new()
	shape.name = "Shape"
	shape.position = position
	var box := RectangleShape2D.new()
	box.size = size
	shape.shape = box
	return shape


## A drawn outline.
static func make_outline(points: PackedVector2Array) -> CollisionPolygon2D:
	var outline := CollisionPolygon2D.new()
	outline.name = "Outline"
	outline.polygon = points
	return outline


## A scene of these nodes.
static func gather(nodes: Array[Node]) -> Node2D:
	var scene := Node2D.new()
	scene.name = "Scene"
	for node: Node in nodes:
		scene.add_child(node)
	return scene
