@tool
extends RefCounted
## The figures that a run began with. What is changed of them meanwhile counts from the next start:
## this tells so, once for each.

# looked at in so many ticks
const _TICKS_TO_LOOK := 15
# figures that count at once, or only say what is done at a start
const _FREE: Array[StringName] = [
	&"mapping_scale",
	&"mapping_rotation",
	&"mapping_turn",
	&"clutched",
	&"gravity_source",
	&"gravity",
	&"show_neighborhood",
	&"default_surface",
	&"auto_start",
	&"arm_at_start",
	&"hold_at_start",
	&"start_link",
	&"moves_freely",
]
# of a link: with what it is grabbed next
const _OF_GRABS: Array[StringName] = [&"grip_point", &"hold_angle"]
const _EXPORTED := PROPERTY_USAGE_SCRIPT_VARIABLE | PROPERTY_USAGE_STORAGE
const _SAY := (
	"%s is %s now, and the loop goes on with what it began with: it counts from the next start."
	+ " Call stop() and start(), or set it before."
)
const _SAY_OTHER := (
	"%s is another one now, and the loop goes on with what it began with: it counts from the next"
	+ " start. Call stop() and start(), or set it before."
)

var _owners: Array[Object] = []
var _names: Array[StringName] = []
var _paths: Array[String] = []
var _values: Array[Variant] = []
var _tick := 0


## The world, its device and limits, and what it holds.
func _init(world: HapticWorld2D, tool: HapticTool2D, links: Array[HapticLink2D]) -> void:
	_note(world, "")
	if links.is_empty():
		_note(tool, "%s." % tool.name)
	for link: HapticLink2D in links:
		_note(link, "%s." % link.name)


## What was changed since, a sentence each, once; mostly nothing.
func changed() -> PackedStringArray:
	_tick += 1
	var told := PackedStringArray()
	if _tick % _TICKS_TO_LOOK != 0:
		return told
	for i: int in range(_names.size() - 1, -1, -1):
		if not is_instance_valid(_owners[i]):
			continue
		var now: Variant = _owners[i].get(_names[i])
		if _is_same(now, _values[i]):
			continue
		if now is Object:
			told.append(_SAY_OTHER % _paths[i])
		else:
			told.append(_SAY % [_paths[i], now])
		_forget(i)
	return told


func _note(owner: Object, path: String) -> void:
	for property: Dictionary in owner.get_property_list():
		var usage: int = property["usage"]
		var called: StringName = property["name"]
		if usage & _EXPORTED != _EXPORTED or called in _FREE:
			continue
		if owner is HapticLink2D and called in _OF_GRABS:
			continue
		var value: Variant = owner.get(called)
		_owners.append(owner)
		_names.append(called)
		_paths.append(path + called)
		_values.append(_copy(value))
		if value is Resource and not value is Script:
			_note(value as Resource, "%s%s." % [path, called])


func _forget(i: int) -> void:
	_owners.remove_at(i)
	_names.remove_at(i)
	_paths.remove_at(i)
	_values.remove_at(i)


# packed arrays change in place
static func _copy(value: Variant) -> Variant:
	if value is Array:
		return (value as Array).duplicate()
	if typeof(value) >= TYPE_PACKED_BYTE_ARRAY:
		return value.duplicate()
	return value


# what is no number is told by the checks
static func _is_same(now: Variant, before: Variant) -> bool:
	return typeof(now) == typeof(before) and (now == before or is_same(now, before) or now != now)
