extends CanvasLayer
## What can be held, a button each: the number on it takes it too, and Tab takes the next. A click
## on a thing takes it there.

const _TEXT := Color(0.91, 0.93, 0.97)
const _QUIET := Color(0.55, 0.59, 0.68)
const _HELD := Color(0.42, 0.86, 0.72)
const _GROUND := Color(0.102, 0.114, 0.149)

## The world that holds it.
@export var world: HapticWorld2D
## What can be held, in the order of the numbers from 1 on: tools, links and rigid bodies.
@export var tools: Array[CollisionObject2D] = []

var _buttons: Array[Button] = []
var _clicked := Vector2.INF


func _ready() -> void:
	_build()
	world.tool_changed.connect(_show.unbind(2))
	_show()


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if not key.pressed or key.echo:
		return
	if key.keycode == KEY_TAB:
		world.take(tools[(tools.find(_held()) + 1) % tools.size()])
	elif key.keycode >= KEY_1 and key.keycode < KEY_1 + tools.size():
		world.take(tools[key.keycode - KEY_1])


func _unhandled_input(event: InputEvent) -> void:
	var button := event as InputEventMouseButton
	if button != null and button.pressed and button.button_index == MOUSE_BUTTON_LEFT:
		_clicked = world.get_global_mouse_position()


# the engine answers what lies at a point in the physics tick alone
func _physics_process(_delta: float) -> void:
	if not _clicked.is_finite():
		return
	var at := _clicked
	_clicked = Vector2.INF
	if not world.is_unattended():
		world.take_at(at)


func _held() -> CollisionObject2D:
	if world.get_held_body() != null:
		return world.get_held_body()
	return world.get_tool()


func _show() -> void:
	var held := _held()
	for i: int in tools.size():
		var color := _HELD if tools[i] == held else _QUIET
		_buttons[i].add_theme_color_override("font_color", color)
		_buttons[i].add_theme_stylebox_override("normal", _box(tools[i] == held))


func _build() -> void:
	var row := HBoxContainer.new()
	row.set_anchors_and_offsets_preset(Control.PRESET_BOTTOM_WIDE)
	row.offset_left = 40.0
	row.offset_right = -40.0
	row.offset_top = -76.0
	row.offset_bottom = -46.0
	row.add_theme_constant_override("separation", 8)
	add_child(row)
	row.add_child(_label("Hold"))
	for i: int in tools.size():
		var button := Button.new()
		button.text = "%d  %s" % [i + 1, tools[i].name]
		button.focus_mode = Control.FOCUS_NONE
		button.add_theme_font_size_override("font_size", 14)
		button.add_theme_color_override("font_hover_color", _TEXT)
		button.add_theme_stylebox_override("hover", _box(false))
		button.add_theme_stylebox_override("pressed", _box(true))
		button.pressed.connect(world.take.bind(tools[i]))
		row.add_child(button)
		_buttons.append(button)
	row.add_child(_label("Tab next"))


static func _label(text: String) -> Label:
	var label := Label.new()
	label.text = text
	label.add_theme_font_size_override("font_size", 14)
	label.add_theme_color_override("font_color", _QUIET)
	return label


static func _box(is_held: bool) -> StyleBoxFlat:
	var box := StyleBoxFlat.new()
	box.bg_color = Color(_HELD, 0.14) if is_held else _GROUND
	box.border_color = Color(_HELD, 0.7) if is_held else Color(_QUIET, 0.3)
	box.set_border_width_all(1)
	box.set_corner_radius_all(5)
	box.set_content_margin_all(6.0)
	box.content_margin_left = 12.0
	box.content_margin_right = 12.0
	return box
