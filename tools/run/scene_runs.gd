extends RefCounted
## Which runs a report makes of a scene, and what it keeps of each.

## Time between two samples of a track, s; native/lab/sweep/include/haptics/sweep/track.hpp.
const INTERVAL := 0.004

## The scene as it is; twice: it has to repeat.
const AS_IT_IS := "as_it_is"
## One integrator, rate and method, with the gains of the scene's own rate and exact encoders.
const SETTING := "setting"
## The same at rates that no device has, for a truth.
const REFERENCE := "reference"
## Everything as the scene has it but integrator and rate, and walls so many times stiffer.
const LOOP := "loop"
## The scene as it is, with its plan and without.
const PLANNED := "planned"
const EVERYTHING := "everything"

const COLUMNS: PackedStringArray = [
	"number",
	"role",
	"method",
	"integrator",
	"rate_hz",
	"stiffer",
	"repeat",
	"file",
	"why_not",
	"seconds",
	"steps",
	"step_ns",
	"simulation_ns",
	"energy_created_j",
	"largest_force_n",
	"deepest_m",
	"collisions",
	"exact_gave_way",
	"touching_ticks",
	"bodies",
	"left_out_bodies",
	"faults",
	"wall_ms",
]
const WALL_COLUMNS: PackedStringArray = [
	"wall",
	"stiffness_n_per_m",
	"damping_n_s_per_m",
	"static_friction",
	"dynamic_friction",
	"restitution",
	"tool_mass_kg",
]

const _INTEGRATORS: PackedStringArray = ["semi_implicit", "linearly_implicit", "exact"]
const _METHODS: PackedStringArray = ["penalty", "penalty_impulse", "paper"]
# each twice the one before; all have whole numbers of steps in INTERVAL
const _REFERENCES: PackedFloat64Array = [16000.0, 32000.0, 64000.0]


## A run of the scene as it is.
static func as_it_is(repeat: int) -> Dictionary:
	return {"role": AS_IT_IS, "repeat": repeat, "stiffer": 1.0}


## All others; `own` is how the scene has it: method, integrator, rate_hz.
static func all(own: Dictionary, quick: bool) -> Array[Dictionary]:
	var runs: Array[Dictionary] = []
	var rates := PackedFloat64Array(
		[500.0, 1000.0, 4000.0] if quick else [250.0, 500.0, 1000.0, 2000.0, 4000.0, 10000.0]
	)
	var repeats := 3 if quick else 7
	for repeat: int in repeats:
		for role: String in [PLANNED, EVERYTHING]:
			var run := own.duplicate()
			run.merge({"role": role, "repeat": repeat, "stiffer": 1.0})
			runs.append(run)
		for method: String in _METHODS:
			if repeat == 0:
				for rate: float in _REFERENCES:
					runs.append(_make(REFERENCE, method, "exact", rate, 0))
			for integrator: String in _INTEGRATORS:
				for rate: float in rates:
					runs.append(_make(SETTING, method, integrator, rate, repeat))
		if repeat == 0:
			for integrator: String in _INTEGRATORS:
				for rate: float in PackedFloat64Array([500.0, 1000.0]) if quick else rates:
					for stiffer: float in [1.0, 100.0] if quick else [1.0, 10.0, 100.0, 1000.0]:
						var run := _make(LOOP, own["method"] as String, integrator, rate, 0)
						run["stiffer"] = stiffer
						runs.append(run)
			runs.append(as_it_is(0))
	return runs


## What is kept of a run's figures.
static func figures_of(figures: Dictionary) -> Dictionary:
	if figures.is_empty():
		return {}
	var step: Dictionary = figures["step_ns"]
	var neighborhood: Dictionary = figures["neighborhood"]
	return {
		"steps": figures["steps"],
		"step_ns": (step["mean"] as float) - (step["simulation"] as float),
		"simulation_ns": step["simulation"],
		"energy_created_j": figures["energy_injected_j"],
		"largest_force_n": figures["max_force_n"],
		"deepest_m": figures["max_penetration_m"],
		"collisions": figures["collisions"],
		"exact_gave_way": figures["exact_gave_way"],
		"left_out_bodies": neighborhood["left_out_bodies"],
		"faults": "; ".join(figures["faults"] as PackedStringArray),
	}


## A row of the table of walls.
static func wall_row(path: String, figures: Array) -> Dictionary:
	var row := {"wall": path}
	for i: int in figures.size():
		row[WALL_COLUMNS[i + 1]] = figures[i]
	return row


static func _make(
	role: String, method: String, integrator: String, rate: float, repeat: int
) -> Dictionary:
	return {
		"role": role,
		"method": method,
		"integrator": integrator,
		"rate_hz": rate,
		"stiffer": 1.0,
		"repeat": repeat,
	}
