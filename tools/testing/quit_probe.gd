extends SceneTree
## A game whose hand leans on a wall in real time, and which then ends: quit_test.sh starts it.
##
##   godot --headless --path . -s res://tools/testing/quit_probe.gd -- process|physics|close|never
##     when it quits: in a frame, in a physics tick, by a request to close; never waits to be killed
##
## Says "pushing" once the hand feels the wall, and with the world's end what it left behind.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Threads := preload("res://tests/support/loop_threads.gd")

# when a run that feels nothing says why, for the log
const _PATIENCE_MS := 30000

var _world: HapticWorld2D
var _native: HapticWorld2D.Gateway
var _way := "process"
var _is_pushing := false
var _is_ending := false
var _has_complained := false


func _initialize() -> void:
	if not OS.get_cmdline_user_args().is_empty():
		_way = OS.get_cmdline_user_args()[0]
	_world = Scene.make_world()
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(_presses())
	_world.mode = HapticWorld2D.Mode.REALTIME
	_world.safety = HapticSafetyLimits.new()
	_world.safety.ramp_time = 0.05
	_world.stopped.connect(_tell)
	root.add_child(
		Scene.gather([_world, Scene.make_tool(), Scene.make_wall(Vector2(0, 70), Vector2(480, 40))])
	)


func _physics_process(_delta: float) -> bool:
	if _native == null and _world.is_running():
		_native = _world._session.native
	if not _is_pushing and _world.is_running() and _world.get_force().length() > 1.0:
		_is_pushing = true
		print("pushing")
	if not _is_pushing and not _has_complained and Time.get_ticks_msec() > _PATIENCE_MS:
		_has_complained = true
		print("nothing is felt: running %s, faults %s" % [_world.is_running(), _world.get_faults()])
	if _is_pushing and _way == "physics" and not _is_ending:
		_is_ending = true
		quit()
	return false


func _process(_delta: float) -> bool:
	if _is_pushing and not _is_ending:
		if _way == "close":
			_is_ending = true
			root.propagate_notification(Node.NOTIFICATION_WM_CLOSE_REQUEST)
			quit()
		# the loop ends by itself when this returns true
		return _way == "process"
	return false


# The hand leans on the wall and lets go, again and again. On a busy machine the first press may
# come before the loop is armed, which it is only in free space, and is never felt; a later one is.
func _presses() -> Array[PackedFloat64Array]:
	var rows: Array[PackedFloat64Array] = []
	for t: int in range(0, 120, 2):
		(
			rows
			. append_array(
				[
					PackedFloat64Array([t, 0.0, 0.0, 0.0]),
					PackedFloat64Array([t + 0.15, 0.0, 0.0, 0.0]),
					PackedFloat64Array([t + 0.3, 0.0, 0.006, 0.0]),
					PackedFloat64Array([t + 1.0, 0.0, 0.006, 0.0]),
					PackedFloat64Array([t + 1.2, 0.0, 0.0, 0.0]),
				]
			)
		)
	return rows


func _tell() -> void:
	print("left: %d loops, force %s" % [Threads.count(), _native.get_last_force()])
