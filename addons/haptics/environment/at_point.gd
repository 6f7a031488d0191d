@tool
extends RefCounted
## Finds what lies at a point and can be held.

# asked for at a point
const _MOST_RESULTS := 32


## What can be held and lies at a point of the canvas: of several the one whose number in the engine
## is lowest, what is held already only without others; null without any. Physics tick only.
static func find(world: HapticWorld2D, point: Vector2) -> CollisionObject2D:
	var query := PhysicsPointQueryParameters2D.new()
	query.position = point
	query.collide_with_areas = true
	var held: CollisionObject2D = world.get_tool() if world.is_running() else null
	var found: CollisionObject2D = null
	for result: Dictionary in world.get_world_2d().direct_space_state.intersect_point(
		query, _MOST_RESULTS
	):
		var collider := result["collider"] as CollisionObject2D
		if not (collider is HapticTool2D or collider is RigidBody2D):
			continue
		if found == null or _comes_before(collider, found, held):
			found = collider
	return found


static func _comes_before(
	one: CollisionObject2D, other: CollisionObject2D, held: CollisionObject2D
) -> bool:
	if one == held or other == held:
		return other == held
	return one.get_instance_id() < other.get_instance_id()
