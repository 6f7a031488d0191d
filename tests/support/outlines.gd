extends RefCounted
## Random outlines that are not convex, drawn and as segments.


## A drawn outline: a solid one mostly, else its edges alone.
static func make(random: RandomNumberGenerator) -> CollisionPolygon2D:
	var outline := CollisionPolygon2D.new()
	change(outline, random)
	return outline


## Draws it anew.
static func change(outline: CollisionPolygon2D, random: RandomNumberGenerator) -> void:
	outline.build_mode = CollisionPolygon2D.BUILD_SOLIDS
	if random.randf() < 0.3:
		outline.build_mode = CollisionPolygon2D.BUILD_SEGMENTS
	outline.polygon = star(random)


## An open line that turns back on itself, or a closed outline.
static func make_segments(random: RandomNumberGenerator) -> ConcavePolygonShape2D:
	var points := star(random)
	var segments := PackedVector2Array()
	var open := 1 if random.randf() < 0.5 else 0
	for i: int in points.size() - open:
		segments.append(points[i])
		segments.append(points[(i + 1) % points.size()])
	var shape := ConcavePolygonShape2D.new()
	shape.segments = segments
	return shape


## Corners around the origin, each at its own distance: simple, and hollow in most cases.
static func star(random: RandomNumberGenerator) -> PackedVector2Array:
	var corners := random.randi_range(4, 10)
	var first := random.randf_range(0.0, TAU)
	var points := PackedVector2Array()
	for i: int in corners:
		var distance := random.randf_range(4.0, 35.0)
		points.append(Vector2.from_angle(first + TAU * i / corners) * distance)
	return points
