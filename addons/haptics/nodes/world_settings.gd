@tool
extends RefCounted
## The settings of a world as the native side takes them.

const Choices := preload("../resources/choices.gd")

## Metadata of a world that is sent its whole scene and runs every stage of its step, whether there
## is something to do or not: to see what is saved otherwise.
const WHOLE_SCENE := &"haptic_whole_scene"

# in the order of the enums of HapticWorld2D
const _COUPLINGS: PackedStringArray = ["four_channel", "virtual_coupling", "direct"]
const _CONTACTS: PackedStringArray = ["penalty_impulse", "penalty"]
## Names of the integrators, in the order of the enum.
const INTEGRATORS: PackedStringArray = ["linearly_implicit", "semi_implicit", "exact"]
const _METHODS: PackedStringArray = ["poisson", "mass_weighted", "paper"]
# rad, as the native side has it
const _MOST_ROTATION := 10.0
const _MOST_TURN := 10000.0
const _TOO_FAR := "%s is %s rad, must lie within %s rad either way. 0 is the default."


static func of(world: HapticWorld2D) -> Dictionary:
	var limits := world.safety if world.safety != null else HapticSafetyLimits.new()
	var tool := world.get_tool()
	var heaviest := tool.mass if tool != null else 0.0
	var largest := tool.inertia if tool != null else 0.0
	if world.device != null:
		heaviest = maxf(heaviest, world.device.moving_mass(world.is_unattended()))
		largest = maxf(largest, world.device.moving_inertia(world.is_unattended()))
	return {
		"rate": world.rate,
		"priority": HapticSettings.number(HapticSettings.PRIORITY),
		"cpu": HapticSettings.number(HapticSettings.PROCESSOR),
		"coupling": Choices.name_of(_COUPLINGS, world.coupling),
		"coupling_stiffness": _axes(world.coupling_stiffness, world.coupling_rotation_stiffness),
		"coupling_damping": _axes(world.coupling_damping, world.coupling_rotation_damping),
		"velocity_window": world.velocity_window,
		"observer": world.observer,
		"hidden_inertia": world.hidden_inertia,
		"passivity_control": world.passivity_control,
		"observer_noise": world.observer_noise,
		"observer_mass_error": world.observer_mass_error,
		"mapping_scale": world.mapping_scale,
		"mapping_rotation": -_sound(world.mapping_rotation, _MOST_ROTATION),
		"arm_at_start": world.arm_at_start,
		"hold_at_start": world.hold_at_start,
		"contact": Choices.name_of(_CONTACTS, world.contact),
		"integrator": Choices.name_of(INTEGRATORS, world.integrator),
		"collision_method": Choices.name_of(_METHODS, world.collision_method),
		"collision_speed": world.collision_speed,
		"whole_scene": world.has_meta(WHOLE_SCENE),
		"safety": limits.to_settings(_within(heaviest, 0.001, 100.0), _within(largest, 1e-6, 10.0)),
	}


## The same for a loop that nobody holds: what moves in it moves by itself.
static func without_hand(world: HapticWorld2D) -> Dictionary:
	var settings := world.to_settings()
	settings["coupling"] = "virtual_coupling"
	settings["observer"] = false
	settings["hold_at_start"] = false
	settings["arm_at_start"] = false
	return settings


## What is wrong with choices and with angles, in words. Angles are told as the scene has them,
## clockwise, and the native side would tell their opposites.
static func problems_of(world: HapticWorld2D) -> PackedStringArray:
	var problems := Choices.problem("mode", world.mode, HapticWorld2D.Mode)
	problems += Choices.problem("gravity_source", world.gravity_source, HapticWorld2D.GravitySource)
	if _sound(world.mapping_rotation, _MOST_ROTATION) != world.mapping_rotation:
		problems.append(_TOO_FAR % ["mapping_rotation", world.mapping_rotation, _MOST_ROTATION])
	if _sound(world.mapping_turn, _MOST_TURN) != world.mapping_turn:
		problems.append(_TOO_FAR % ["mapping_turn", world.mapping_turn, _MOST_TURN])
	return problems


## How the handle holds the tool: mapping, clutch and turn, for [method HapticServer.world_place].
static func placement(world: HapticWorld2D) -> Dictionary:
	return {
		"mapping_scale": world.mapping_scale,
		"mapping_rotation": -world.mapping_rotation,
		"clutched": world.clutched,
		"turn": -world.mapping_turn,
	}


# the least for what is no number: whose figure it is says so
static func _within(figure: float, least: float, most: float) -> float:
	return clampf(figure, least, most) if is_finite(figure) else least


# 0 for an angle that is no number or beyond `most`
static func _sound(angle: float, most: float) -> float:
	return angle if absf(angle) <= most else 0.0


static func _axes(along: float, around: float) -> PackedFloat64Array:
	return PackedFloat64Array([along, along, around])


## Gravity as the native side takes it: x, y (m/s², y up, the world's axes).
static func pull_of(world: HapticWorld2D) -> PackedFloat64Array:
	var units := HapticUnits.new(world.pixels_per_meter, world.global_transform)
	match world.gravity_source:
		HapticWorld2D.GravitySource.PROJECT:
			var space := world.get_world_2d().space
			var strength: float = PhysicsServer2D.area_get_param(
				space, PhysicsServer2D.AREA_PARAM_GRAVITY
			)
			var direction: Vector2 = PhysicsServer2D.area_get_param(
				space, PhysicsServer2D.AREA_PARAM_GRAVITY_VECTOR
			)
			return units.velocity_to_meters(strength * direction)
		HapticWorld2D.GravitySource.CUSTOM:
			return units.vector_to_native(world.gravity)
	return PackedFloat64Array([0.0, 0.0])
