extends Node
## Lets a test wait. Time is counted in physics ticks, as the scene under test sees it.

## Emitted when the wait that was started last is over.
signal finished

## Whether the last wait ended because its time (or its frames) ran out.
var timed_out: bool = false

var _seconds_left: float = INF
var _frames_left: int = 0
var _counts_physics: bool = false
var _predicate: Callable = Callable()
var _ends_on: bool = true
var _interval: float = 0.0
var _since_call: float = 0.0
var _awaited: Signal = Signal()
var _is_running: bool = false


func _ready() -> void:
	get_tree().process_frame.connect(_on_frame.bind(false))
	get_tree().physics_frame.connect(_on_frame.bind(true))


func _physics_process(delta: float) -> void:
	if not _is_running:
		return
	_seconds_left -= delta
	var is_over: bool = _seconds_left <= 0.0
	if _predicate.is_valid():
		_since_call += delta
		if _since_call >= _interval:
			_since_call = 0.0
			var answer: Variant = _predicate.call()
			if (answer is bool and answer == true) == _ends_on:
				_finish(is_over)
				return
	if is_over:
		_finish(true)


## Waits [param seconds] of scene time.
func start_seconds(seconds: float) -> void:
	_start()
	_seconds_left = seconds


## Waits until [param count] whole frames (or physics ticks) have gone by.
func start_frames(count: int, physics: bool) -> void:
	_start()
	_frames_left = count + 1
	_counts_physics = physics


## Waits until [param awaited] is emitted, at most [param seconds].
func start_signal(awaited: Signal, seconds: float) -> void:
	_start()
	_seconds_left = seconds
	_awaited = awaited
	awaited.connect(_on_awaited, CONNECT_ONE_SHOT)


## Waits until [param predicate] returns [code]true[/code] (or, with [param until] false, anything
## else), asked every [param interval] seconds, at most [param seconds].
func start_predicate(predicate: Callable, seconds: float, interval: float, until: bool) -> void:
	_start()
	_seconds_left = seconds
	_predicate = predicate
	_interval = interval
	_ends_on = until


func _start() -> void:
	_drop_awaited()
	_seconds_left = INF
	_frames_left = 0
	_predicate = Callable()
	_since_call = 0.0
	timed_out = false
	_is_running = true


func _finish(by_time: bool) -> void:
	_drop_awaited()
	_is_running = false
	timed_out = by_time
	finished.emit()


func _drop_awaited() -> void:
	if not _awaited.is_null() and is_instance_id_valid(_awaited.get_object_id()):
		if _awaited.is_connected(_on_awaited):
			_awaited.disconnect(_on_awaited)
	_awaited = Signal()


func _on_frame(physics: bool) -> void:
	if not _is_running or _frames_left == 0 or physics != _counts_physics:
		return
	_frames_left -= 1
	if _frames_left == 0:
		_finish(_awaited.is_null())


## The wait ends two frames later, so that everything else that listens has run by then.
func _on_awaited(..._arguments: Array) -> void:
	_frames_left = 2
	_counts_physics = false
	_seconds_left = INF
