@tool
extends RefCounted
## Turns the buttons of a world's device into its signal, also across restarts of the loop: a button
## that stays down while another tool is taken was pressed once.

const Gateway := preload("gateway.gd")

# as the device has them
const _COUNT := 32

var _world: HapticWorld2D
var _pressed := 0


func _init(world: HapticWorld2D) -> void:
	_world = world


## True while that button is down.
func is_pressed(button: int) -> bool:
	return button >= 0 and button < _COUNT and _pressed & (1 << button) != 0


## Looks at the newest report, once a physics tick.
func follow() -> void:
	var state := _world.get_state()
	# a loop that has not stepped knows of no buttons
	if not state.is_empty() and state[Gateway.State.STEP] > 0.0:
		tell(int(state[Gateway.State.BUTTONS]))


## Bit i is button i.
func tell(pressed: int) -> void:
	var changed := pressed ^ _pressed
	_pressed = pressed
	for button: int in _COUNT:
		if changed & (1 << button) != 0:
			_world.button_changed.emit(button, pressed & (1 << button) != 0)
