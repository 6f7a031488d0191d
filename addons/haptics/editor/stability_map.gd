@tool
extends RefCounted
## Which walls were seen to be stable, from the maps of the last full laboratory report; made by
## tools/report/stability_map.py. Walls of 20 N s/m; docs/reports.md says how stability is judged.
##
## Between measured points it takes the worse side, so that what it promises was seen on both.

const FILE := "res://addons/haptics/editor/stability_map.json"

# in the order of the enums of HapticWorld2D
const _INTEGRATORS: PackedStringArray = ["linearly_implicit", "semi_implicit", "exact"]
const _COUPLINGS: PackedStringArray = ["four_channel", "virtual_coupling", "direct"]
# a rate or a mass that is off by less is the measured one
const _SAME := 1e-6

var _proxy: Array = []
var _device: Array = []


## Reads the maps. Empty maps, after an error, when there is no such file.
func _init(file: String = FILE) -> void:
	var text := FileAccess.get_file_as_string(file)
	var maps: Variant = JSON.parse_string(text) if text != "" else null
	if not maps is Dictionary:
		push_error("%s is no stability map; make it with tools/report/stability_map.py." % file)
		return
	_proxy = (maps as Dictionary).get("proxy", [])
	_device = (maps as Dictionary).get("device", [])


## Stiffest wall, N/m, up to which a tool of `mass` (kg) alone was stable at `rate` (Hz); 0 when
## none was, and outside of what was measured (slower, lighter or heavier).
func stiffest_wall(integrator: HapticWorld2D.Integrator, rate: float, mass: float) -> float:
	var own := _proxy.filter(
		func(row: Dictionary) -> bool: return row["integrator"] == _INTEGRATORS[integrator]
	)
	var at := _at_most(own, "rate_hz", rate)
	return minf(_value(_at_most(at, "mass_kg", mass)), _value(_at_least(at, "mass_kg", mass)))


## The same with a device in the loop (0.3 kg, 1 N s/m, its mass known to within a quarter) that is
## late by `delay_steps` and whose encoder has steps of `encoder` (m); 0 outside of what was
## measured (slower, later or coarser).
func stiffest_wall_through_device(
	coupling: HapticWorld2D.Coupling, rate: float, delay_steps: int, encoder: float
) -> float:
	var own := _device.filter(
		func(row: Dictionary) -> bool: return row["coupling"] == _COUPLINGS[coupling]
	)
	var late := _at_least(_at_most(own, "rate_hz", rate), "delay_steps", delay_steps)
	return _value(_at_least(late, "encoder_m", encoder))


# rows of the largest figure that is at most `limit`
func _at_most(rows: Array, figure: String, limit: float) -> Array:
	var best := -INF
	for row: Dictionary in rows:
		var here: float = row[figure]
		if here <= limit * (1.0 + _SAME):
			best = maxf(best, here)
	return rows.filter(func(row: Dictionary) -> bool: return row[figure] == best)


# rows of the smallest figure that is at least `limit`
func _at_least(rows: Array, figure: String, limit: float) -> Array:
	var best := INF
	for row: Dictionary in rows:
		var here: float = row[figure]
		if here >= limit * (1.0 - _SAME):
			best = minf(best, here)
	return rows.filter(func(row: Dictionary) -> bool: return row[figure] == best)


static func _value(rows: Array) -> float:
	return (rows[0] as Dictionary)["stiffest_n_per_m"] if not rows.is_empty() else 0.0
