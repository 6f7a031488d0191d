@tool
class_name HapticSettings
extends RefCounted
## The project settings under haptics/*: what belongs to a project or a machine, not to a scene.

## No world gives more force than this, N, whatever its limits say.
const FORCE_CEILING := "haptics/safety/force_ceiling"
## Priority of the loop's thread where the system grants real-time scheduling, 1 to 80; 0 asks
## for none.
const PRIORITY := "haptics/loop/priority"
## Processor that the loop is bound to; -1 binds it to none.
const PROCESSOR := "haptics/loop/processor"
## Input action that takes the force off at once. Empty, or not in the input map: Escape.
const STOP_ACTION := "haptics/input/stop_action"

const _DEFAULTS: Dictionary[String, Variant] = {
	FORCE_CEILING: 20.0,
	PRIORITY: 80,
	PROCESSOR: -1,
	STOP_ACTION: "",
}
const _HINTS: Dictionary[String, String] = {
	FORCE_CEILING: "0.01,100,0.01,suffix:N",
	PRIORITY: "0,80,1",
	PROCESSOR: "-1,255,1",
}


## A setting that is a number.
static func number(name: String) -> float:
	return float(ProjectSettings.get_setting(name, _DEFAULTS[name]))


## A setting that is text.
static func text(name: String) -> String:
	return str(ProjectSettings.get_setting(name, _DEFAULTS[name]))


## Shows the settings in the project settings dialog.
static func register() -> void:
	for name: String in _DEFAULTS:
		if not ProjectSettings.has_setting(name):
			ProjectSettings.set_setting(name, _DEFAULTS[name])
		ProjectSettings.set_initial_value(name, _DEFAULTS[name])
		ProjectSettings.set_as_basic(name, true)
		var info := {"name": name, "type": typeof(_DEFAULTS[name])}
		if _HINTS.has(name):
			info["hint"] = PROPERTY_HINT_RANGE
			info["hint_string"] = _HINTS[name]
		ProjectSettings.add_property_info(info)
