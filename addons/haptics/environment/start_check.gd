@tool
extends RefCounted
## Finds bodies that the tool overlaps where it starts. Works on nodes and shapes alone, so in the
## editor too, where physics stands still.

# as deep as this is still touching, m
const _SLACK := 0.0002


## The first body that the tool starts inside of; null when it is free.
static func find_overlap(tool: HapticTool2D, root: Node, slack_pixels: float) -> CollisionObject2D:
	for node: Node in root.find_children("*", "PhysicsBody2D", true, false):
		var body := node as PhysicsBody2D
		if body.collision_layer & tool.collision_mask == 0:
			continue
		if body.get_world_2d() != tool.get_world_2d():
			continue
		if _overlap(tool, body, slack_pixels):
			return body
	return null


## Bodies that the tool's mask selects and that have nothing but separation rays: the engine's
## broad phase does not even find those.
static func find_rays_alone(tool: HapticTool2D, root: Node) -> Array[PhysicsBody2D]:
	var found: Array[PhysicsBody2D] = []
	for node: Node in root.find_children("*", "PhysicsBody2D", true, false):
		var body := node as PhysicsBody2D
		if body.collision_layer & tool.collision_mask == 0:
			continue
		if body.get_world_2d() == tool.get_world_2d() and _has_rays_alone(body):
			found.append(body)
	return found


static func _has_rays_alone(body: PhysicsBody2D) -> bool:
	var has_rays := false
	for owner_id: int in body.get_shape_owners():
		for index: int in body.shape_owner_get_shape_count(owner_id):
			if not body.shape_owner_get_shape(owner_id, index) is SeparationRayShape2D:
				return false
			has_rays = true
	return has_rays


## Depth that still counts as touching, px.
static func slack(units: HapticUnits) -> float:
	return units.to_pixels(_SLACK)


static func _overlap(a: CollisionObject2D, b: CollisionObject2D, slack_pixels: float) -> bool:
	for mine: Array in _shapes(a):
		for theirs: Array in _shapes(b):
			var points := (mine[0] as Shape2D).collide_and_get_contacts(
				mine[1] as Transform2D, theirs[0] as Shape2D, theirs[1] as Transform2D
			)
			for i: int in range(0, points.size() - 1, 2):
				if points[i].distance_to(points[i + 1]) > slack_pixels:
					return true
	return false


static func _shapes(body: CollisionObject2D) -> Array[Array]:
	var found: Array[Array] = []
	for owner_id: int in body.get_shape_owners():
		if body.is_shape_owner_disabled(owner_id):
			continue
		var place := body.global_transform * body.shape_owner_get_transform(owner_id)
		for index: int in body.shape_owner_get_shape_count(owner_id):
			var shape := body.shape_owner_get_shape(owner_id, index)
			if not shape is SeparationRayShape2D:
				found.append([shape, place])
	return found
