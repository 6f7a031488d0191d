@tool
@icon("res://addons/haptics/icons/haptic_five_bar.svg")
class_name HapticFiveBar
extends Resource
## One five-bar of a [HapticPantographGeometry]: two motors, an arm of two links on each, and the
## end point that both arms hold.
##
## Everything is in the axes of the device's drawing: x to the right, y up, angles
## counter-clockwise. Left and right are as seen from the motors. The defaults are the links of the
## Pantograph Mk-II.

## A side, looking along an arm or from one elbow to the other.
enum ArmSide {
	## Counter-clockwise of the line of sight.
	LEFT,
	## Clockwise of it.
	RIGHT,
}

const Choices := preload("choices.gd")

const _SIDES: PackedStringArray = ["left", "right"]

@export_group("Motor axes")
## Middle between the two motor axes, m, each coordinate within 1.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var center: Vector2 = Vector2(0.0, -0.09)
## Turn of the five-bar: at 0 its end point works above its motors. -360° to 360°.
@export_range(-180.0, 180.0, 0.01, "or_less", "or_greater", "radians_as_degrees")
var angle: float = 0.0
## Distance of the two motor axes, m, 0 (coaxial) to 1.
@export_range(0.0, 0.2, 0.0001, "or_greater", "suffix:m") var spacing: float = 0.025

@export_group("Lengths")
## Driven link of the left arm, from its axis to its elbow, m, 0.005 to 1.
@export_range(0.005, 0.3, 0.0001, "or_greater", "suffix:m") var left_proximal_length: float = 0.063
## Link of the left arm from the elbow to the end point, m, 0.005 to 1.
@export_range(0.005, 0.3, 0.0001, "or_greater", "suffix:m") var left_distal_length: float = 0.075
## Driven link of the right arm, m, 0.005 to 1.
@export_range(0.005, 0.3, 0.0001, "or_greater", "suffix:m") var right_proximal_length: float = 0.063
## Link of the right arm from the elbow to the end point, m, 0.005 to 1.
@export_range(0.005, 0.3, 0.0001, "or_greater", "suffix:m") var right_distal_length: float = 0.075

@export_group("Modes")
## Side of the left arm's elbow, looking from its axis to the end point.
@export var left_elbow: ArmSide = ArmSide.LEFT
## Side of the right arm's elbow, looking from its axis to the end point.
@export var right_elbow: ArmSide = ArmSide.RIGHT
## Side of the end point, looking from the left elbow to the right one.
@export var end_side: ArmSide = ArmSide.LEFT

@export_group("Masses")
## Mass of a driven link, kg, 0 to 5. The same for both arms, as are the figures below.
@export_range(0.0, 0.5, 0.0001, "or_greater", "suffix:kg") var proximal_mass: float = 0.0126
## Its center of mass as a share of the way from axis to elbow, 0 to 1.
@export_range(0.0, 1.0, 0.001) var proximal_center: float = 0.5
## Its moment of inertia about that center, kg m², 0 to 1.
@export_range(0.0, 0.001, 0.0000001, "or_greater", "suffix:kg m²")
var proximal_inertia: float = 4.16745e-06
## Mass of a link from elbow to end point, kg, 0 to 5.
@export_range(0.0, 0.5, 0.0001, "or_greater", "suffix:kg") var distal_mass: float = 0.015
## Its center of mass as a share of the way from elbow to end point, 0 to 1.
@export_range(0.0, 1.0, 0.001) var distal_center: float = 0.5
## Its moment of inertia about that center, kg m², 0 to 1.
@export_range(0.0, 0.001, 0.0000001, "or_greater", "suffix:kg m²")
var distal_inertia: float = 7.03125e-06


## As the native side takes it.
func to_settings() -> Dictionary:
	return {
		"center": PackedFloat64Array([center.x, center.y]),
		"angle": angle,
		"spacing": spacing,
		"left_proximal_length": left_proximal_length,
		"left_distal_length": left_distal_length,
		"right_proximal_length": right_proximal_length,
		"right_distal_length": right_distal_length,
		"left_elbow": Choices.name_of(_SIDES, left_elbow),
		"right_elbow": Choices.name_of(_SIDES, right_elbow),
		"end_side": Choices.name_of(_SIDES, end_side),
		"proximal_mass": proximal_mass,
		"proximal_center": proximal_center,
		"proximal_inertia": proximal_inertia,
		"distal_mass": distal_mass,
		"distal_center": distal_center,
		"distal_inertia": distal_inertia,
	}


## A five-bar with these figures, keys as from [method to_settings].
static func from_settings(settings: Dictionary) -> HapticFiveBar:
	var bar := HapticFiveBar.new()
	for key: String in settings:
		match key:
			"center":
				var place: PackedFloat64Array = settings[key]
				bar.center = Vector2(place[0], place[1])
			"left_elbow", "right_elbow", "end_side":
				bar.set(key, _SIDES.find(settings[key] as String))
			_:
				bar.set(key, settings[key])
	return bar
