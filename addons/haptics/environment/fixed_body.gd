@tool
extends "body_reader.gd"
## StaticBody2D and HapticWall2D. One that a script moves counts as kinematic from then on.

var _moves := false


func kind() -> String:
	return "kinematic" if _moves else "fixed"


func read_state(tick: int, seconds: float) -> PackedFloat64Array:
	var state := super.read_state(tick, seconds)
	if not _moves and Vector3(_state[3], _state[4], _state[5]).length() > REST_SPEED:
		_moves = true
		is_dirty = true
	return state
