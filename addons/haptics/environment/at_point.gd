@tool
extends RefCounted
## Finds what lies at a point and can be held.

# asked for at a point
const _MOST_RESULTS := 32


## What can be held and lies at a point of the canvas: of several the one whose number in the engine
## is lowest; null without one. Physics tick only.
static func find(world: HapticWorld2D, point: Vector2) -> CollisionObject2D:
	var query := PhysicsPointQueryParameters2D.new()
	query.position = point
	query.collide_with_areas = true
	var found: CollisionObject2D = null
	for result: Dictionary in world.get_world_2d().direct_space_state.intersect_point(
		query, _MOST_RESULTS
	):
		var collider := result["collider"] as CollisionObject2D
		if not (collider is HapticTool2D or collider is RigidBody2D):
			continue
		if found == null or collider.get_instance_id() < found.get_instance_id():
			found = collider
	return found
