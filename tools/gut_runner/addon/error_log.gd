extends Logger
## Collects every error the engine reports, from whichever thread, until the runner takes them.

const TrackedError := preload("res://addons/gut/gut_tracked_error.gd")
const NOISE_FILE := "res://addons/gut/known_noise.txt"

var _mutex: Mutex = Mutex.new()
var _errors: Array[GutTrackedError] = []
var _noise: Array[RegEx] = []


func _init() -> void:
	for text: String in FileAccess.get_file_as_string(NOISE_FILE).split("\n"):
		var pattern: String = text.strip_edges()
		if not pattern.is_empty() and not pattern.begins_with("#"):
			_noise.append(RegEx.create_from_string(pattern))


## Called by the engine, on the thread that raised the error.
func _log_error(
	function: String,
	file: String,
	line: int,
	code: String,
	rationale: String,
	editor_notify: bool,
	error_type: int,
	script_backtraces: Array[ScriptBacktrace]
) -> void:
	var error: GutTrackedError = TrackedError.new()
	error.function = function
	error.file = file
	error.line = line
	error.code = code
	error.rationale = rationale
	error.editor_notify = editor_notify
	error.error_type = error_type
	error.backtrace = script_backtraces
	if _is_noise(error):
		return
	_mutex.lock()
	_errors.append(error)
	_mutex.unlock()


## What was reported since the last [method take]; handled flags set on it are kept.
func peek() -> Array[GutTrackedError]:
	_mutex.lock()
	var found: Array[GutTrackedError] = _errors.duplicate()
	_mutex.unlock()
	return found


## What was reported since the last call, which is then forgotten here.
func take() -> Array[GutTrackedError]:
	_mutex.lock()
	var found: Array[GutTrackedError] = _errors
	_errors = []
	_mutex.unlock()
	return found


## Of [param errors], the lines of those that nobody accounted for. A push_warning never counts.
static func unexpected(errors: Array[GutTrackedError]) -> PackedStringArray:
	var lines: PackedStringArray = []
	for error: GutTrackedError in errors:
		if not error.handled and not error.is_push_warning():
			lines.append(error.to_s())
	return lines


func _is_noise(error: GutTrackedError) -> bool:
	for pattern: RegEx in _noise:
		if pattern.search(error.code) != null or pattern.search(error.rationale) != null:
			return true
	return false
