@tool
@icon("res://addons/haptics/icons/haptic_surface.svg")
class_name HapticSurface
extends Resource
## How a surface feels: its spring, its damper, its friction and its bounce.
##
## Where a tool with a surface of its own touches, springs act in series, dampers likewise; the
## smoother side decides the friction, the livelier one the restitution. A tool without one leaves
## the surface as it is. The defaults are the wall of Constantinescu, Salcudean and Croft (2003).

## Sets of figures to start from.
enum Preset {
	## Figures of your own.
	CUSTOM,
	## The paper's wall: 15000 N/m, 20 N s/m, no friction.
	RIGID,
	## Hard and grippy: 12000 N/m, friction 0.4.
	WOOD,
	## Bouncy and grippy: 3000 N/m, friction 0.9, restitution 0.6.
	RUBBER,
	## Soft and dead: 600 N/m, friction 0.5.
	FOAM,
	## Hard and slippery: 15000 N/m, friction 0.03.
	ICE,
}

const _FIGURES: Dictionary[Preset, Array] = {
	Preset.RIGID: [15000.0, 20.0, 0.0, 0.0, 0.0],
	Preset.WOOD: [12000.0, 20.0, 0.4, 0.3, 0.2],
	Preset.RUBBER: [3000.0, 6.0, 0.9, 0.7, 0.6],
	Preset.FOAM: [600.0, 12.0, 0.5, 0.4, 0.0],
	Preset.ICE: [15000.0, 20.0, 0.03, 0.02, 0.1],
}

## Fills the figures below with those of a material. Shows [constant CUSTOM] when they are none's.
@export_custom(PROPERTY_HINT_ENUM, "Custom,Rigid,Wood,Rubber,Foam,Ice", PROPERTY_USAGE_EDITOR)
var preset: Preset:
	get = _get_preset,
	set = _set_preset

## Stiffness of one contact patch along its normal, N/m. Stiffer feels harder; what the loop can
## hold stable depends on its rate, the tool's mass and the integrator. 0 or more.
@export_range(0.0, 100000.0, 1.0, "or_greater", "exp", "suffix:N/m") var stiffness: float = 15000.0:
	set(value):
		stiffness = value
		emit_changed()

## Damping of one contact patch along its normal, N s/m. 0 or more.
@export_range(0.0, 1000.0, 0.1, "or_greater", "suffix:N s/m") var damping: float = 20.0:
	set(value):
		damping = value
		emit_changed()

## Coulomb coefficient while a contact sticks. At least [member dynamic_friction].
@export_range(0.0, 2.0, 0.01, "or_greater") var static_friction: float = 0.0:
	set(value):
		static_friction = value
		emit_changed()

## Coulomb coefficient while a contact slides. 0 or more.
@export_range(0.0, 2.0, 0.01, "or_greater") var dynamic_friction: float = 0.0:
	set(value):
		dynamic_friction = value
		emit_changed()

## Poisson's coefficient of restitution: 0 stops dead, 1 loses nothing.
@export_range(0.0, 1.0, 0.01) var restitution: float = 0.0:
	set(value):
		restitution = value
		emit_changed()


## A surface with the figures of a preset.
static func create(from: Preset) -> HapticSurface:
	var surface := HapticSurface.new()
	surface.preset = from
	return surface


## Chooses stiffness and damping so that `mass` (kg) on this surface oscillates at `frequency` (Hz)
## with the given damping ratio (1 is critical).
func set_frequency(mass: float, frequency: float, damping_ratio: float) -> void:
	var omega := TAU * frequency
	stiffness = mass * omega * omega
	damping = 2.0 * damping_ratio * mass * omega


## Frequency at which `mass` (kg) oscillates on this surface without damping, Hz.
func get_frequency(mass: float) -> float:
	return sqrt(stiffness / mass) / TAU


## Damping over critical damping for `mass` (kg) on this surface.
func get_damping_ratio(mass: float) -> float:
	return damping / (2.0 * sqrt(stiffness * mass))


## As the native side takes it.
func to_settings() -> Dictionary:
	return {
		"stiffness": stiffness,
		"damping": damping,
		"static_friction": static_friction,
		"dynamic_friction": dynamic_friction,
		"restitution": restitution,
	}


func _get_preset() -> Preset:
	var figures := [stiffness, damping, static_friction, dynamic_friction, restitution]
	for candidate: Preset in _FIGURES:
		if _FIGURES[candidate] == figures:
			return candidate
	return Preset.CUSTOM


func _set_preset(value: Preset) -> void:
	if not _FIGURES.has(value):
		return
	var figures := _FIGURES[value]
	stiffness = figures[0]
	damping = figures[1]
	static_friction = figures[2]
	dynamic_friction = figures[3]
	restitution = figures[4]
	notify_property_list_changed()
