@tool
extends RefCounted
## Whether a node stands somewhere, and whether a world can turn its pixels into meters.

const MOST_PIXELS_PER_METER := 1e9
const LEAST_PIXELS_PER_METER := 1e-3


## What is wrong with where `node` stands, in words.
static func of(node: Node2D) -> PackedStringArray:
	if node.global_transform.is_finite():
		return []
	return [
		(
			(
				"It stands at %s, turned by %s rad, scaled by %s, which is no place."
				+ " Give it, and its parents, a real one."
			)
			% [node.global_position, node.global_rotation, node.global_scale]
		)
	]


## What is wrong with the scale and skew of a node that the loop moves: it keeps neither.
static func of_shape(node: Node2D) -> PackedStringArray:
	if not node.global_scale.is_equal_approx(Vector2.ONE):
		return ["The scale is %s. Set it to 1 and scale the shapes instead." % node.global_scale]
	if not is_zero_approx(node.global_skew):
		return ["The skew is %s rad. Set it to 0 and draw the shapes skewed." % node.global_skew]
	return []


## False when the world's pixels have no size in meters.
static func can_measure(world: HapticWorld2D) -> bool:
	var scale := world.pixels_per_meter
	return (
		scale >= LEAST_PIXELS_PER_METER
		and scale <= MOST_PIXELS_PER_METER
		and world.global_transform.is_finite()
	)
