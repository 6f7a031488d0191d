extends RefCounted
## Remembers what the engine logs, so that a test can ask for an error and none goes unseen.

var logger: Listener = Listener.new()


## All errors since the last take.
func take() -> Array[String]:
	var taken: Array[String] = logger.errors.duplicate()
	logger.errors.clear()
	return taken


## Takes all errors; true when one holds the text.
func take_containing(text: String) -> bool:
	return take().any(func(error: String) -> bool: return error.contains(text))


## Takes all messages; true when one is the text.
func take_message(text: String) -> bool:
	var found: bool = logger.messages.has(text)
	logger.messages.clear()
	return found


## File name of the last error.
func last_place() -> String:
	return logger.place


class Listener:
	extends Logger

	var errors: Array[String] = []
	var messages: Array[String] = []
	var place: String = ""

	func _log_error(
		_function: String,
		file: String,
		_line: int,
		code: String,
		rationale: String,
		_editor_notify: bool,
		_error_type: int,
		_backtraces: Array[ScriptBacktrace]
	) -> void:
		errors.append(rationale if not rationale.is_empty() else code)
		place = file.get_file()

	func _log_message(message: String, _error: bool) -> void:
		messages.append(message.strip_edges())
