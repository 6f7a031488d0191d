@tool
@icon("res://addons/haptics/icons/haptic_hand_cursor_2d.svg")
class_name HapticHandCursor2D
extends Node2D
## The mouse as a hand: where the cursor is, the simulated hand wants the tool's grip to be.
##
## A world whose device is held by a hand of kind MOUSE makes one for itself. The hand takes the
## tool when the cursor comes to it, or when the left button is pressed; the right button leaves it
## where it is. The wheel, or Q and E, turn it. The ring shows where the hand wants to be, the line
## how far the tool stays behind.

## What to tell a player in one line.
const HELP := "Move onto the tool to take it  ·  wheel or Q E turn it  ·  right button leaves it"

const Warnings := preload("warnings.gd")
const DrawingChecks := preload("drawing_checks.gd")

# how near the cursor has to come, px on the screen
const _NEAR := 26.0
# how fast the hand comes to the cursor when it was taken from afar, m/s
const _FETCH_SPEED := 0.15
# turn of a notch of the wheel, and speed of the keys, rad and rad/s
const _NOTCH := deg_to_rad(6.0)
const _TURN_SPEED := deg_to_rad(90.0)
const _MOST_TURN := deg_to_rad(55.0)
# letting go and taking hold again, with some room, s
const _CHANGE := 0.25
const _COLOR := Color(0.553, 0.647, 0.953)

var _warnings := Warnings.new(self, DrawingChecks.of_cursor.bind(self))
var _is_engaged := false
# how long the hand rests where it is once it was told to take another part, s
var _rest := 0.0
var _holds_another := false
# from the cursor to where the hand still is, px
var _lag := Vector2.ZERO
var _angle := 0.0
var _first_angle := 0.0


func _init() -> void:
	top_level = true
	z_index = 100
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF


func _ready() -> void:
	if _world() == null:
		set_process(false)
		set_process_unhandled_input(false)
		hide()
		return
	_first_angle = _world().get_grip().get_rotation()
	_angle = _first_angle


func _notification(what: int) -> void:
	_warnings.follow(what)


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()


## True while the hand follows the cursor.
func is_engaged() -> bool:
	return _is_engaged


## Where the hand wants the grip, on the canvas.
func get_wish() -> Vector2:
	return get_global_mouse_position() + _lag


## The hand stays where it is, and soon takes what comes near the cursor: for a world that gives it
## something else to hold.
func let_go() -> void:
	_is_engaged = false
	_rest = _CHANGE
	_holds_another = true


func _unhandled_input(event: InputEvent) -> void:
	var button := event as InputEventMouseButton
	if button == null or not button.pressed:
		return
	match button.button_index:
		MOUSE_BUTTON_LEFT:
			_engage()
		MOUSE_BUTTON_RIGHT:
			_is_engaged = false
		MOUSE_BUTTON_WHEEL_UP:
			_turn(-_NOTCH)
		MOUSE_BUTTON_WHEEL_DOWN:
			_turn(_NOTCH)


func _process(delta: float) -> void:
	var world := _world()
	if not world.is_running():
		return
	queue_redraw()
	_rest = maxf(_rest - delta, 0.0)
	if not _is_engaged:
		if _rest > 0.0:
			return
		if get_global_mouse_position().distance_to(world.get_grip().origin) > _near():
			return
		_engage()
	_turn(_TURN_SPEED * delta * float(_pressed(KEY_E) - _pressed(KEY_Q)))
	_lag = _lag.move_toward(Vector2.ZERO, _FETCH_SPEED * world.pixels_per_meter * delta)
	world.aim(get_wish(), _angle)


func _draw() -> void:
	var grip := _world().get_grip().origin
	var zoom := 1.0 / _pixel()
	draw_set_transform(Vector2.ZERO)
	if not _is_engaged:
		# where to take it
		draw_arc(grip, _near(), 0.0, TAU, 48, Color(_COLOR, 0.35), 1.5 / zoom, true)
		return
	var wish := get_wish()
	var ring := 9.0 / zoom
	draw_line(grip, wish, Color(_COLOR, 0.55), 1.5 / zoom, true)
	draw_arc(wish, ring, 0.0, TAU, 32, Color(_COLOR, 0.95), 2.0 / zoom, true)
	var direction := Vector2.from_angle(_angle) * ring
	draw_line(wish + direction, wish + direction * 1.6, _COLOR, 2.0 / zoom, true)
	draw_line(wish - direction, wish - direction * 1.6, _COLOR, 2.0 / zoom, true)


# from where the tool is: nothing jumps
func _engage() -> void:
	if _is_engaged or _rest > 0.0:
		return
	_is_engaged = true
	if _holds_another:
		_holds_another = false
		_first_angle = _world().get_handle().get_rotation()
		_angle = _first_angle
	_lag = _world().get_handle().origin - get_global_mouse_position()


func _turn(by: float) -> void:
	if _is_engaged:
		_angle = clampf(_angle + by, _first_angle - _MOST_TURN, _first_angle + _MOST_TURN)


func _near() -> float:
	return _NEAR * _pixel()


# size of a pixel of the screen on the canvas
func _pixel() -> float:
	return 1.0 / maxf(get_viewport_transform().get_scale().x, 0.001)


func _pressed(key: Key) -> int:
	return 1 if Input.is_physical_key_pressed(key) else 0


func _world() -> HapticWorld2D:
	return get_parent() as HapticWorld2D
