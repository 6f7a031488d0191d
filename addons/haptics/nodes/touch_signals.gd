@tool
extends RefCounted
## Turns what the loop reports into signals, on the main thread, in time order: those of the tool,
## and touch_began and touch_ended of every body whose class or script has them.
##
## For each body touch_began and touch_ended alternate, whatever the queue of events lost while the
## main thread was busy: what the report touches and nobody was told of is told then.

const _BEGAN := &"touch_began"
const _ENDED := &"touch_ended"
# report and events are not of the same instant: only a difference that lasts is a loss, frames
const _FRAMES_OF_DOUBT := 3

## What touches now, by number; null values are gone.
var touching: Dictionary[int, Node2D] = {}

var _tool: HapticTool2D
var _doubt := 0


func _init(tool: HapticTool2D) -> void:
	_tool = tool


## `events` in time order, a contact each; `touched` are the bodies of the newest report. `body_of`
## finds a body by its number.
func emit(events: Array, touched: PackedInt64Array, units: HapticUnits, body_of: Callable) -> void:
	for event: Dictionary in events:
		var number: int = event["body"]
		var body: Node2D = body_of.call(number)
		var contact := HapticContact.from_report(event, units, body)
		match event["kind"]:
			"began":
				_begin(number, contact)
			"ended":
				_end(number, contact)
			"impact":
				_tool.impacted.emit(contact, event["impulse"] as float)
			"slip":
				_tool.slip_began.emit(contact)
	_reconcile(events.is_empty(), touched, body_of)


## The loop ends, so nothing touches any more.
func finish() -> void:
	for number: int in touching.keys():
		_end(number, HapticContact.new())


func _begin(number: int, contact: HapticContact) -> void:
	if touching.has(number):
		return
	touching[number] = contact.body
	_tool.contact_began.emit(contact)
	if contact.body != null and contact.body.has_signal(_BEGAN):
		contact.body.emit_signal(_BEGAN, _tool, contact)


func _end(number: int, contact: HapticContact) -> void:
	if not touching.has(number):
		return
	var body: Node2D = null
	if is_instance_valid(touching[number]):
		body = touching[number]
	touching.erase(number)
	contact.body = body
	_tool.contact_ended.emit(contact)
	if is_instance_valid(body) and body.has_signal(_ENDED):
		body.emit_signal(_ENDED, _tool, contact)


func _reconcile(is_quiet: bool, touched: PackedInt64Array, body_of: Callable) -> void:
	var lost: Array[int] = []
	for number: int in touching:
		if not number in touched:
			lost.append(number)
	for number: int in touched:
		if not touching.has(number):
			lost.append(number)
	_doubt = _doubt + 1 if is_quiet and not lost.is_empty() else 0
	if _doubt < _FRAMES_OF_DOUBT:
		return
	_doubt = 0
	for number: int in lost:
		var contact := HapticContact.new()
		contact.body = body_of.call(number)
		if touching.has(number):
			_end(number, contact)
		else:
			_begin(number, contact)
