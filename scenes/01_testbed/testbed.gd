extends Node2D
## The testbed of section 5 of the paper: an enclosure of rigid walls, a moving object, and a
## grounded three-link structure. The hand holds the rigid tool or any link of the structure.

@onready var _world: HapticWorld2D = $World


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if not key.pressed or key.echo:
		return
	match key.keycode:
		KEY_R:
			_world.arm()
		KEY_N:
			_world.show_neighborhood = not _world.show_neighborhood
