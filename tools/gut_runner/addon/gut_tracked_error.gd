class_name GutTrackedError
extends RefCounted
## One error or warning the engine reported, with what is needed to judge it and to find it.

## What failed, as the engine words it; for push_error and push_warning the message itself.
var code: String = ""
## The engine's explanation, when it gives one besides [member code].
var rationale: String = ""
## A value of [enum Logger.ErrorType].
var error_type: int = -1
## Whether the engine also shows it in the editor.
var editor_notify: bool = false
## Where it was raised: a script, or a file of the engine.
var file: String = ""
## The function that raised it; "push_error" and "push_warning" for those two.
var function: String = ""
## The line in [member file].
var line: int = -1
## Script stacks at the time, one for each language.
var backtrace: Array[ScriptBacktrace] = []
## Set once an assert (or the test itself) has accounted for this error.
var handled: bool = false


## Whether it came from push_error().
func is_push_error() -> bool:
	return function == "push_error"


## Whether it came from push_warning().
func is_push_warning() -> bool:
	return function == "push_warning"


## Whether it came from the engine, an extension or a failing script.
func is_engine_error() -> bool:
	return not is_push_error() and not is_push_warning()


## Whether [param text] occurs in the message, in any letter case.
func contains_text(text: String) -> bool:
	return code.containsn(text) or rationale.containsn(text)


## Where the script code that caused it stands, as "file:line"; empty when no script was running.
func script_place() -> String:
	for trace: ScriptBacktrace in backtrace:
		for frame: int in trace.get_frame_count():
			var frame_file: String = trace.get_frame_file(frame)
			if not frame_file.begins_with("res://addons/gut/"):
				return "%s:%d" % [frame_file, trace.get_frame_line(frame)]
	return ""


## One line for a report: kind, message, place.
func to_s() -> String:
	var kind: String = "engine error"
	if is_push_error():
		kind = "push_error"
	elif is_push_warning():
		kind = "push_warning"
	var message: String = code if rationale.is_empty() else "%s (%s)" % [rationale, code]
	var place: String = script_place()
	if place.is_empty():
		place = "%s:%d" % [file, line]
	return "%s: %s [%s]" % [kind, message, place]
