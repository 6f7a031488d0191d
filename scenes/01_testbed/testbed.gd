extends Node2D
## The testbed of section 5 of the paper, without its linkage: an enclosure, an object, a tool.

@onready var _world: HapticWorld2D = $World


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if key.pressed and not key.echo and key.keycode == KEY_R:
		_world.arm()
