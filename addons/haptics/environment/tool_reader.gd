@tool
extends RefCounted
## Reads the tool of a world into what the native side takes.

const ShapeReader := preload("shape_reader.gd")


## `problems` is added to.
static func describe(
	tool: HapticTool2D, units: HapticUnits, problems: PackedStringArray
) -> Dictionary:
	var reader := ShapeReader.new(units)
	reader.read(tool.get_shape_source(), Transform2D.IDENTITY)
	problems.append_array(reader.problems)
	var body := {
		"kind": "tool",
		"mass": tool.mass,
		"inertia": tool.inertia,
		"center": units.local_to_meters(tool.center_of_mass),
		"rounding": tool.rounding,
		"shapes": reader.shapes,
	}
	if tool.surface != null:
		body["surface"] = tool.surface.to_settings()
	return {
		"body": body,
		"grip_point": units.local_to_meters(tool.grip_point),
		"grip_pose": tool.grip == HapticTool2D.Grip.POSE,
		"start": units.pose_to_meters(tool.global_transform),
	}


## Distance from the tool's origin to its farthest point, px.
static func extent(tool: CollisionObject2D) -> float:
	var farthest := 0.0
	for owner_id: int in tool.get_shape_owners():
		var place := tool.shape_owner_get_transform(owner_id)
		for index: int in tool.shape_owner_get_shape_count(owner_id):
			var bounds := place * tool.shape_owner_get_shape(owner_id, index).get_rect()
			var x := maxf(absf(bounds.position.x), absf(bounds.end.x))
			var y := maxf(absf(bounds.position.y), absf(bounds.end.y))
			farthest = maxf(farthest, Vector2(x, y).length())
	return farthest
