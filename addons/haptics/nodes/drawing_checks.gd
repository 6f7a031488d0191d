@tool
extends RefCounted
## What can be wrong with the nodes that only draw, in words that name the value and the fix. One
## that is wrong draws nothing.

const NO_WORLD := "There is no HapticWorld2D in this scene: nothing is drawn. Add one."

# px and px/N
const _MOST := 1e5


## Arrows of forces.
static func of_arrows(arrows: HapticForceArrows2D) -> PackedStringArray:
	var problems := PackedStringArray()
	if arrows.is_inside_tree() and arrows.world == null and HapticWorld2D.find_for(arrows) == null:
		problems.append(NO_WORLD)
	return problems + figures_of_arrows(arrows)


## Those of its figures that are wrong.
static func figures_of_arrows(arrows: HapticForceArrows2D) -> PackedStringArray:
	var problems := PackedStringArray()
	_range("pixels_per_newton", arrows.pixels_per_newton, 1e-3, "px/N", "18", problems)
	_range("longest", arrows.longest, 1e-3, "px", "110", problems)
	_range("threshold", arrows.threshold, 0.0, "N", "0.05", problems)
	_range("width", arrows.width, 1e-3, "px", "2", problems)
	return problems


## A skin of shapes.
static func of_skin(skin: HapticShapeSkin2D) -> PackedStringArray:
	var problems := PackedStringArray()
	if skin.is_inside_tree() and not skin.get_parent() is CollisionObject2D:
		(
			problems
			. append(
				(
					"It paints the shapes of its parent, and %s has none. Make it a child of a body or tool."
					% skin.get_parent().name
				)
			)
		)
	return problems + figures_of_skin(skin)


## Those of its figures that are wrong.
static func figures_of_skin(skin: HapticShapeSkin2D) -> PackedStringArray:
	var problems := PackedStringArray()
	_range("edge_width", skin.edge_width, 0.0, "px", "1.5", problems)
	_range("pointer", skin.pointer, 0.0, "px", "0", problems)
	return problems


## A cursor of a hand.
static func of_cursor(cursor: HapticHandCursor2D) -> PackedStringArray:
	if not cursor.is_inside_tree() or cursor.get_parent() is HapticWorld2D:
		return []
	return [
		"It is not a child of a HapticWorld2D and shows nothing. Remove it: the world makes its own."
	]


# no number lies in no range
static func _range(
	called: String,
	figure: float,
	least: float,
	unit: String,
	usual: String,
	problems: PackedStringArray
) -> void:
	if not (figure >= least and figure <= _MOST):
		problems.append(
			(
				"%s is %s %s, must lie between %s and %s. %s is the default."
				% [called, figure, unit, least, _MOST, usual]
			)
		)
