@tool
extends "body_reader.gd"
## StaticBody2D and HapticWall2D. One that a script moves counts as kinematic from then on.

var _moves := false


func kind() -> String:
	return "kinematic" if _moves else "fixed"


func _follow(at: Transform2D, tick: int, seconds: float) -> void:
	super._follow(at, tick, seconds)
	if not _moves and Vector3(_state[3], _state[4], _state[5]).length() > REST_SPEED:
		_moves = true
		is_dirty = true
