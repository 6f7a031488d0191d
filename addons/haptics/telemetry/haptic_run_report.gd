@tool
class_name HapticRunReport
extends RefCounted
## What a run of a haptic world did, as data, as files and as text.

## Name of the file of figures.
const FIGURES := "run.json"
## Name of the file of rows, one a haptic step.
const ROWS := "run.csv"

## The figures, named as in run.json.
var figures: Dictionary

var _world: HapticWorld2D


## Takes the figures of a world that runs.
func _init(world: HapticWorld2D, scene: String) -> void:
	_world = world
	figures = {"scene": scene}
	figures.merge(world.get_statistics())
	figures["library_version"] = HapticWorld2D.Gateway.version()
	figures["godot_version"] = Engine.get_version_info()["string"]


## Writes run.json and, when the run was recorded, run.csv into that folder. OK, or an error that
## was said.
func write(folder: String) -> Error:
	var made := DirAccess.make_dir_recursive_absolute(folder)
	var file := FileAccess.open(folder.path_join(FIGURES), FileAccess.WRITE)
	if made != OK or file == null:
		push_error(
			(
				"Cannot write %s (%s). Choose a folder that can be written to."
				% [folder.path_join(FIGURES), error_string(FileAccess.get_open_error())]
			)
		)
		return FAILED
	file.store_string(JSON.stringify(figures, "  ", false) + "\n")
	file.close()
	if _world.record_seconds <= 0.0:
		return OK
	return _world.save_recording(folder.path_join(ROWS))


## A summary to read.
func summary() -> String:
	var steps: int = figures.get("steps", 0)
	var rate: float = figures.get("haptic_rate_hz", 0.0)
	var wake: Dictionary = figures.get("wake_latency_us", {})
	var step: Dictionary = figures.get("step_ns", {})
	var faults: PackedStringArray = figures.get("faults", PackedStringArray())
	var lines: PackedStringArray = [
		"Haptic run of %s" % figures["scene"],
		_line("mode", "%s, %s" % [figures.get("mode", "-"), figures.get("scheduling", "-")]),
		_line(
			"haptic steps",
			(
				"%d at %.0f Hz (%.2f s), %d deadlines missed, %d scene ticks"
				% [
					steps,
					rate,
					steps / maxf(rate, 1.0),
					figures.get("missed_deadlines", 0),
					figures.get("ve_ticks", 0)
				]
			)
		),
	]
	if figures.get("mode") == "realtime":
		lines.append(
			_line(
				"wake latency",
				(
					"%.0f / %.0f / %.0f / %.0f µs (p50 / p99 / p99.9 / max)"
					% [wake["p50"], wake["p99"], wake["p999"], wake["max"]]
				)
			)
		)
	if not step.is_empty():
		lines.append(
			_line(
				"step time",
				(
					"%.1f / %.1f / %.1f µs (p50 / p99 / max)"
					% [step["p50"] * 1e-3, step["p99"] * 1e-3, step["max"] * 1e-3]
				)
			)
		)
	var tick: Dictionary = figures.get("tick_us", {})
	if not tick.is_empty():
		lines.append(
			_line(
				"scene tick",
				(
					"%.0f / %.0f / %.0f µs (p50 / p99 / max) on the main thread"
					% [tick["p50"], tick["p99"], tick["max"]]
				)
			)
		)
	(
		lines
		. append_array(
			[
				_line("largest force", "%.2f N" % figures.get("max_force_n", 0.0)),
				_line(
					"deepest penetration", "%.0f µm" % (figures.get("max_penetration_m", 0.0) * 1e6)
				),
				_line(
					"position error",
					"%.0f µm rms" % (figures.get("rms_position_error_m", 0.0) * 1e6)
				),
				_line("collisions", "%d" % figures.get("collisions", 0)),
				_line("energy injected", "%.3f mJ" % (figures.get("energy_injected_j", 0.0) * 1e3)),
				_line("faults", "none" if faults.is_empty() else "; ".join(faults)),
			]
		)
	)
	var wait: String = figures.get("force_waits_for", "")
	if not wait.is_empty():
		lines.append(_line("no force yet", wait))
	return "\n".join(lines)


static func _line(title: String, text: String) -> String:
	return "  %-20s %s" % [title, text]
