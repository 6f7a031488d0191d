@tool
extends RefCounted
## The key that takes the force off: the action that the settings name, else Escape.


## True for the event that presses it.
static func is_pressed(event: InputEvent) -> bool:
	var action := HapticSettings.text(HapticSettings.STOP_ACTION)
	if action != "" and InputMap.has_action(action):
		return event.is_action_pressed(action)
	var key := event as InputEventKey
	return key != null and key.pressed and not key.echo and key.keycode == KEY_ESCAPE
