@tool
extends RefCounted
## Reads the collision shapes of a body into what the native side takes.

## What was read: one Dictionary a shape.
var shapes: Array[Dictionary] = []
## What cannot be touched, and what to do about it.
var problems: PackedStringArray = []

var _units: HapticUnits
var _one_way := false


func _init(units: HapticUnits) -> void:
	_units = units


## Reads every shape of the body that is not disabled. `scaling` brings points from the body's own
## axes to its axes without scale (Godot scales static bodies, our poses carry no scale).
func read(body: CollisionObject2D, scaling: Transform2D) -> void:
	for owner_id: int in body.get_shape_owners():
		if body.is_shape_owner_disabled(owner_id):
			continue
		var place := scaling * body.shape_owner_get_transform(owner_id)
		_one_way = body.is_shape_owner_one_way_collision_enabled(owner_id)
		var holder := body.shape_owner_get_owner(owner_id) as Node
		# ids outlive ticks: contact states hang on them
		var first_id := owner_id * 1024 + 1
		var outline := holder as CollisionPolygon2D
		if outline != null and outline.build_mode == CollisionPolygon2D.BUILD_SOLIDS:
			# the drawn outline, not Godot's cut of it: no edges inside
			_add_polygon(first_id, outline.polygon, place, holder)
			continue
		var count := body.shape_owner_get_shape_count(owner_id)
		if count == 0:
			_complain(holder, "has no shape. Give it one, or remove it.")
		for index: int in count:
			_read_shape(
				first_id + index, body.shape_owner_get_shape(owner_id, index), place, holder
			)


## Takes one outline (px), as the tiles of a layer have them.
func add_outline(id: int, points: PackedVector2Array, place: Transform2D, one_way: bool) -> void:
	_one_way = one_way
	_add_polygon(id, points, place, null)


## Distance from the origin to the farthest point of what was read, m; infinite with a half-plane.
func extent() -> float:
	var farthest := 0.0
	for shape: Dictionary in shapes:
		if shape["kind"] == "half_plane":
			return INF
		var points: PackedFloat64Array = shape["points"]
		for i: int in range(0, points.size() - 1, 2):
			var distance := Vector2(points[i], points[i + 1]).length()
			farthest = maxf(farthest, distance + (shape.get("radius", 0.0) as float))
	return farthest


func _read_shape(id: int, shape: Shape2D, place: Transform2D, holder: Node) -> void:
	if shape is RectangleShape2D:
		var half := (shape as RectangleShape2D).size / 2.0
		var corners: PackedVector2Array = [
			-half, Vector2(half.x, -half.y), half, Vector2(-half.x, half.y)
		]
		_add_polygon(id, corners, place, holder)
	elif shape is CircleShape2D:
		_add_round(id, "circle", [Vector2.ZERO], (shape as CircleShape2D).radius, place)
	elif shape is CapsuleShape2D:
		var capsule := shape as CapsuleShape2D
		var reach := capsule.height / 2.0 - capsule.radius
		if reach <= 0.0:
			_add_round(id, "circle", [Vector2.ZERO], capsule.radius, place)
		else:
			var ends: PackedVector2Array = [Vector2(0.0, -reach), Vector2(0.0, reach)]
			_add_round(id, "capsule", ends, capsule.radius, place)
	elif shape is SegmentShape2D:
		var segment := shape as SegmentShape2D
		_add(id, "segment", place * PackedVector2Array([segment.a, segment.b]), place)
	elif shape is ConvexPolygonShape2D:
		_add_polygon(id, (shape as ConvexPolygonShape2D).points, place, holder)
	elif shape is ConcavePolygonShape2D:
		_add_segments(id, (shape as ConcavePolygonShape2D).segments, place, holder)
	elif shape is WorldBoundaryShape2D:
		_add_half_plane(id, shape as WorldBoundaryShape2D, place)
	elif shape is SeparationRayShape2D:
		_complain(
			holder,
			"is a SeparationRayShape2D, which has no surface to touch. Use another kind of shape."
		)
	else:
		_complain(holder, "has a shape of a kind that cannot be touched (%s)." % shape)


func _add_polygon(id: int, points: PackedVector2Array, place: Transform2D, holder: Node) -> void:
	if points.size() < 3:
		_complain(
			holder,
			(
				"has an outline of %d points, which encloses nothing. Give it at least 3."
				% points.size()
			)
		)
		return
	_add(id, "polygon", place * points, place)


func _add_segments(id: int, points: PackedVector2Array, place: Transform2D, holder: Node) -> void:
	if points.is_empty():
		_complain(holder, "has no segments. Draw at least one, or remove it.")
	for i: int in range(0, points.size() - 1, 2):
		var ends: PackedVector2Array = [points[i], points[i + 1]]
		_add(id + floori(i / 2.0), "segment", place * ends, place)


func _add_round(
	id: int, kind: String, points: PackedVector2Array, radius: float, place: Transform2D
) -> void:
	# Godot has no ellipses either: the larger scale counts
	var growth := maxf(place.x.length(), place.y.length())
	_add(id, kind, place * points, place)
	shapes[-1]["radius"] = _units.to_meters(radius * growth)


func _add_half_plane(id: int, boundary: WorldBoundaryShape2D, place: Transform2D) -> void:
	var point := boundary.normal * boundary.distance
	var along := place.basis_xform(boundary.normal.orthogonal())
	var normal := along.orthogonal().normalized()
	if normal.dot(place.basis_xform(boundary.normal)) < 0.0:
		normal = -normal
	_add(id, "half_plane", [place * point], place)
	var flat: PackedFloat64Array = shapes[-1]["points"]
	# a direction: flipped, not scaled
	flat.append_array(PackedFloat64Array([normal.x, -normal.y]))
	shapes[-1]["points"] = flat


func _add(id: int, kind: String, points: PackedVector2Array, place: Transform2D) -> void:
	var flat := PackedFloat64Array()
	for point: Vector2 in points:
		flat.append_array(_units.local_to_meters(point))
	var shape := {"id": id, "kind": kind, "points": flat}
	if _one_way:
		# Godot lets bodies through that come from below: the free side is the shape's own -y
		var free := -place.y.normalized()
		shape["one_way"] = true
		shape["one_way_normal"] = PackedFloat64Array([free.x, -free.y])
	shapes.append(shape)


func _complain(holder: Node, text: String) -> void:
	problems.append("%s %s" % [holder.name if holder != null else &"A shape", text])
