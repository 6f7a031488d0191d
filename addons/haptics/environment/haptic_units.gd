@tool
class_name HapticUnits
extends RefCounted
## Pixels and meters: the only place that converts.
##
## With p pixels per meter: x = X/p, y = -Y/p, angle = -Angle, impulse J·p, inertia I·p². The native
## side is y up and relative to the world node; poses there are kept in double precision, so the
## world's origin is taken off before anything is divided.

## Scale, px/m, above 0.
var pixels_per_meter: float
## Grows whenever the world node's pose changes.
var frame := 0

var _frame_pose := Transform2D.IDENTITY
var _origin_x := 0.0
var _origin_y := 0.0
var _angle := 0.0
var _cos := 1.0
var _sin := 0.0


func _init(scale: float = 4000.0, pose: Transform2D = Transform2D.IDENTITY) -> void:
	pixels_per_meter = scale
	set_frame(pose)


## Takes the pose of the world node over. Its scale is not: a scaled world is refused. A pose that
## is no place leaves the last one.
func set_frame(pose: Transform2D) -> void:
	if pose == _frame_pose or not pose.is_finite():
		return
	frame += 1
	_frame_pose = pose
	_origin_x = pose.origin.x
	_origin_y = pose.origin.y
	_angle = pose.get_rotation()
	_cos = cos(_angle)
	_sin = sin(_angle)


## Meters in so many pixels.
func to_meters(pixels: float) -> float:
	return pixels / pixels_per_meter


## Pixels in so many meters.
func to_pixels(meters: float) -> float:
	return meters * pixels_per_meter


## A point or length in the axes of a node (px) as x, y (m, y up).
func local_to_meters(pixels: Vector2) -> PackedFloat64Array:
	return PackedFloat64Array([pixels.x / pixels_per_meter, -pixels.y / pixels_per_meter])


## A point on the canvas (px) as x, y relative to the world node (m, y up).
func point_to_meters(canvas: Vector2) -> PackedFloat64Array:
	var x := canvas.x - _origin_x
	var y := canvas.y - _origin_y
	return PackedFloat64Array(
		[(_cos * x + _sin * y) / pixels_per_meter, (_sin * x - _cos * y) / pixels_per_meter]
	)


## x, y relative to the world node (m, y up) as a point on the canvas (px).
func point_to_canvas(x: float, y: float) -> Vector2:
	var along := x * pixels_per_meter
	var down := -y * pixels_per_meter
	return Vector2(_origin_x + _cos * along - _sin * down, _origin_y + _sin * along + _cos * down)


## A vector of the native side (any unit, y up) in the canvas's axes, same unit.
func vector_to_canvas(x: float, y: float) -> Vector2:
	return Vector2(_cos * x + _sin * y, _sin * x - _cos * y)


## A vector in the canvas's axes in those of the native side, same unit.
func vector_to_native(canvas: Vector2) -> PackedFloat64Array:
	return PackedFloat64Array(
		[_cos * canvas.x + _sin * canvas.y, _sin * canvas.x - _cos * canvas.y]
	)


## An angle on the canvas as an angle of the native side, rad.
func angle_to_native(canvas: float) -> float:
	return -(canvas - _angle)


## An angle of the native side as an angle on the canvas, rad.
func angle_to_canvas(native: float) -> float:
	return _angle - native


## Pose x, y, angle (m, rad) of a node on the canvas.
func pose_to_meters(canvas: Transform2D) -> PackedFloat64Array:
	var pose := point_to_meters(canvas.origin)
	pose.append(angle_to_native(canvas.get_rotation()))
	return pose


## Where a node at x, y, angle (m, rad) is on the canvas, without scale.
func pose_to_canvas(x: float, y: float, angle: float) -> Transform2D:
	return Transform2D(angle_to_canvas(angle), point_to_canvas(x, y))


## A velocity on the canvas (px/s) in m/s, y up.
func velocity_to_meters(canvas: Vector2) -> PackedFloat64Array:
	var velocity := vector_to_native(canvas)
	velocity[0] /= pixels_per_meter
	velocity[1] /= pixels_per_meter
	return velocity


## An impulse x, y (N s, y up) in Godot's unit (kg px/s).
func impulse_to_canvas(x: float, y: float) -> Vector2:
	return vector_to_canvas(x, y) * pixels_per_meter


## An angular impulse (N m s) in Godot's unit (kg px²/s).
func angular_impulse_to_canvas(angular: float) -> float:
	return -angular * pixels_per_meter * pixels_per_meter


## A moment of inertia in Godot's unit (kg px²) in kg m².
func inertia_to_meters(inertia: float) -> float:
	return inertia / (pixels_per_meter * pixels_per_meter)
