extends CanvasLayer
## What a haptic world does, in figures along the top of the window, and one line of help below.

const _TEXT := Color(0.91, 0.93, 0.97)
const _QUIET := Color(0.55, 0.59, 0.68)
const _GOOD := Color(0.42, 0.86, 0.72)
# as HapticForceArrows2D draws them
const _CONTACT := Color(1.0, 0.62, 0.36)
const _HAND := Color(0.42, 0.86, 0.72)
const _SHADE := Color(0.07, 0.075, 0.09, 0.9)
const _BAD := Color(1.0, 0.5, 0.42)
# a force that is off for shorter needs no explanation, s
const _PATIENCE := 1.0
# how often the figures change, s: slower than that they can be read
const _PERIOD := 0.1

## Name of the scene.
@export var title: String = ""
## What one can do here.
@export var help: String = ""
## Shown in place of [member help] while a recorded hand moves the tool.
@export var help_unattended: String = "A recorded hand moves the tool"
## The world to show; without one the first in the tree.
@export var world: HapticWorld2D

var _values: Dictionary[String, Label] = {}
var _help_label: Label
var _fault_label: Label
var _largest := 0.0
var _deepest := 0.0
var _wait := 0.0
# how long the force has been off without a fault, s
var _off := 0.0


func _ready() -> void:
	_build()
	if world == null:
		world = get_tree().get_first_node_in_group(HapticWorld2D.WORLDS) as HapticWorld2D


func _process(delta: float) -> void:
	if world == null:
		return
	# the largest since the last change: taps are shorter than a frame
	_largest = maxf(_largest, world.get_force().length())
	_deepest = maxf(_deepest, world.get_penetration())
	_wait -= delta
	if _wait > 0.0:
		return
	_wait = _PERIOD
	_put("Force", "%.2f N" % _largest)
	_put("Penetration", "%.0f µm" % (_deepest * 1e6))
	_put("Contact", _contact_text())
	var figures := world.get_statistics()
	_put("Loop", _loop_text(figures))
	# what was granted beside it is in the summary of a run
	_put("Scheduling", (figures.get("scheduling", "–") as String).get_slice(",", 0))
	_show_output(figures)
	_largest = 0.0
	_deepest = 0.0
	_help_label.text = help_unattended if world.is_unattended() else help


func _contact_text() -> String:
	var contacts := world.get_contacts()
	if contacts.is_empty():
		return "free"
	var names: PackedStringArray = ["free", "colliding", "sticking", "sliding"]
	var state := HapticContact.State.NONE
	for contact: HapticContact in contacts:
		state = maxi(state, contact.state) as HapticContact.State
	return names[state] + (" ×%d" % contacts.size() if contacts.size() > 1 else "")


func _loop_text(figures: Dictionary) -> String:
	if figures.is_empty():
		return "stopped"
	var step: Dictionary = figures["step_ns"]
	return "%.0f Hz · %.1f µs" % [figures["haptic_rate_hz"], step["p50"] * 1e-3]


func _show_output(figures: Dictionary) -> void:
	var faults: PackedStringArray = figures.get("faults", PackedStringArray())
	var text := "waiting"
	var color := _QUIET
	if not faults.is_empty():
		text = "off"
		color = _BAD
	elif world.is_armed():
		text = "on"
		color = _GOOD
	elif not world.is_running():
		text = "stopped"
		color = _BAD
	_put("Output", text, color)
	var missing: String = figures.get("force_waits_for", "")
	_off = 0.0 if missing.is_empty() else _off + _PERIOD
	var explains := _off > _PATIENCE
	_fault_label.text = "No force yet. " + missing if explains else "\n".join(faults)
	_fault_label.add_theme_color_override("font_color", _TEXT if explains else _BAD)


func _put(key: String, text: String, color: Color = _TEXT) -> void:
	_values[key].text = text
	_values[key].add_theme_color_override("font_color", color)


func _build() -> void:
	var bar := HBoxContainer.new()
	bar.set_anchors_and_offsets_preset(Control.PRESET_TOP_WIDE)
	bar.offset_left = 40.0
	bar.offset_right = -40.0
	bar.offset_top = 18.0
	bar.add_theme_constant_override("separation", 12)
	add_child(bar)
	var heading := _label(title, 24, _TEXT)
	heading.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	heading.vertical_alignment = VERTICAL_ALIGNMENT_CENTER
	bar.add_child(heading)
	for key: String in ["Force", "Penetration", "Contact", "Loop", "Scheduling", "Output"]:
		var wide := key in ["Contact", "Loop", "Scheduling"]
		bar.add_child(_column(key, 160.0 if wide else 104.0))
	# a scene's walls may be as light as the words
	var shade := ColorRect.new()
	shade.color = _SHADE
	shade.mouse_filter = Control.MOUSE_FILTER_IGNORE
	shade.set_anchors_and_offsets_preset(Control.PRESET_BOTTOM_WIDE)
	shade.offset_top = -44.0
	add_child(shade)
	_help_label = _label(help, 14, _QUIET)
	_help_label.horizontal_alignment = HORIZONTAL_ALIGNMENT_RIGHT
	_help_label.set_anchors_and_offsets_preset(Control.PRESET_BOTTOM_WIDE)
	_help_label.offset_top = -32.0
	_help_label.offset_right = -40.0
	_help_label.offset_bottom = -12.0
	add_child(_help_label)
	_build_legend()
	_fault_label = _label("", 18, _BAD)
	_fault_label.horizontal_alignment = HORIZONTAL_ALIGNMENT_CENTER
	_fault_label.set_anchors_and_offsets_preset(Control.PRESET_TOP_WIDE)
	_fault_label.offset_top = 84.0
	add_child(_fault_label)


func _build_legend() -> void:
	var legend := HBoxContainer.new()
	legend.set_anchors_and_offsets_preset(Control.PRESET_BOTTOM_LEFT)
	legend.offset_left = 40.0
	legend.offset_top = -32.0
	legend.offset_bottom = -12.0
	legend.add_theme_constant_override("separation", 8)
	for entry: Array in [["surface on tool", _CONTACT], ["felt by the hand", _HAND]]:
		var swatch := ColorRect.new()
		swatch.color = entry[1]
		swatch.custom_minimum_size = Vector2(14, 4)
		swatch.size_flags_vertical = Control.SIZE_SHRINK_CENTER
		legend.add_child(swatch)
		legend.add_child(_label(entry[0] as String, 14, _QUIET))
	add_child(legend)


func _column(key: String, width: float) -> Control:
	var column := VBoxContainer.new()
	column.custom_minimum_size.x = width
	column.add_theme_constant_override("separation", -2)
	column.add_child(_label(key, 13, _QUIET))
	var value := _label("–", 18, _TEXT)
	value.clip_text = true
	column.add_child(value)
	_values[key] = value
	return column


static func _label(text: String, size: int, color: Color) -> Label:
	var label := Label.new()
	label.text = text
	label.mouse_filter = Control.MOUSE_FILTER_IGNORE
	label.add_theme_font_size_override("font_size", size)
	label.add_theme_color_override("font_color", color)
	return label
