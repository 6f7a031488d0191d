@tool
extends RefCounted
## Shows what is wrong with a node: in the editor as configuration warnings, renewed only when they
## change; in a game as errors, once each.

# between two looks in the editor, s; nodes look at different times
const _PERIOD := 0.7

var _node: Node
var _find: Callable
var _shown: PackedStringArray = []
var _said: Dictionary[String, bool] = {}
var _wait := 0.0


## `find` returns a PackedStringArray of what is wrong.
func _init(node: Node, find: Callable) -> void:
	_node = node
	_find = find
	_wait = fmod(node.get_instance_id() * 0.0137, _PERIOD)


## For _get_configuration_warnings().
func shown() -> PackedStringArray:
	return _shown


## For the node's _notification(): scripts that extend the node cannot lose it.
func follow(what: int) -> void:
	match what:
		Node.NOTIFICATION_ENTER_TREE:
			if Engine.is_editor_hint():
				_node.get_tree().process_frame.connect(_look)
		Node.NOTIFICATION_EXIT_TREE:
			if Engine.is_editor_hint():
				_node.get_tree().process_frame.disconnect(_look)
		Node.NOTIFICATION_READY:
			if not Engine.is_editor_hint():
				# once the whole scene is there
				say.call_deferred()


## For a running game: says what is new.
func say() -> void:
	if is_instance_valid(_node) and _node.is_inside_tree():
		say_these(_find.call() as PackedStringArray)


## Says what is new among these.
func say_these(problems: PackedStringArray) -> void:
	for text: String in _named(problems):
		if not _said.has(text):
			_said[text] = true
			push_error(text)


func _look() -> void:
	_wait -= _node.get_process_delta_time()
	if _wait > 0.0:
		return
	_wait = _PERIOD
	var now := _named(_find.call() as PackedStringArray)
	if now == _shown:
		return
	_shown = now
	_node.update_configuration_warnings()


func _named(problems: PackedStringArray) -> PackedStringArray:
	var named := PackedStringArray()
	var path := String(_node.name)
	if _node.is_inside_tree() and not Engine.is_editor_hint():
		path = String(_node.get_path())
	for text: String in problems:
		named.append("%s: %s" % [path, text])
	return named
