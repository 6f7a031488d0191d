@tool
extends RefCounted
## Finds what a world holds when nobody said so, and makes tools of what goes into the hand.

const HeldBody := preload("held_body.gd")
const AtPoint := preload("../environment/at_point.gd")


## The first rigid tool of the world's World2D; without one the start link of the first linkage;
## null without both.
static func find_first(world: HapticWorld2D) -> HapticTool2D:
	var first: HapticLink2D = null
	for other: Node in world.get_tree().get_nodes_in_group(HapticWorld2D.TOOLS):
		var tool := other as HapticTool2D
		if tool == null or tool is HeldBody or tool.get_world_2d() != world.get_world_2d():
			continue
		var link := tool as HapticLink2D
		if link == null:
			return tool
		if first == null and link.get_linkage() != null:
			first = link.get_linkage().get_start_link()
	return first


## Takes what lies at a point of the canvas, there; a rigid tool at its grip_point. Physics tick
## only.
static func take_at(world: HapticWorld2D, point: Vector2) -> bool:
	var what := AtPoint.find(world, point)
	var link := what as HapticLink2D
	if link != null and link.get_linkage() != null:
		return link.get_linkage().grab(link, link.to_local(point))
	return what != null and world.take(what, what.to_local(point))


## The tool for what goes into the hand, a body's is made for it; null, after an error, when it
## cannot be held.
static func for_hand(world: HapticWorld2D, what: CollisionObject2D, at: Vector2) -> HapticTool2D:
	var problem := ""
	if what == null or not what.is_inside_tree() or what.get_world_2d() != world.get_world_2d():
		problem = "got %s" % what
	elif not (what is HapticTool2D or what is RigidBody2D):
		problem = "%s is neither" % what.get_path()
	elif what is HapticLink2D and (what as HapticLink2D).get_linkage() == null:
		problem = "%s is a link without a HapticLinkage2D" % what.get_path()
	elif not at.is_finite():
		problem = "the point is %s" % at
	if problem != "":
		push_error(
			(
				"%s: take() needs a tool, a link or a RigidBody2D in its own World2D, and a finite point; %s."
				% [world.get_path(), problem]
			)
		)
		return null
	if what is HapticTool2D:
		return what as HapticTool2D
	var held := HeldBody.new()
	held.body = what as RigidBody2D
	held.grip_point = at
	return held


## A body's tool joins the scene, after what was held before was let go.
static func begin(world: HapticWorld2D, tool: HapticTool2D) -> void:
	var held := tool as HeldBody
	if held == null:
		return
	var units := HapticUnits.new(world.pixels_per_meter, world.global_transform)
	held.stand_for(held.body, held.grip_point, units)
	world.add_child(held, false, Node.INTERNAL_MODE_BACK)
	held.global_transform = Transform2D(held.body.global_rotation, held.body.global_position)


## A body that could not be taken has no tool.
static func forget(tool: HapticTool2D) -> void:
	if tool is HeldBody:
		tool.queue_free()


## The body that `tool` stands for, else null.
static func body_of(tool: HapticTool2D) -> RigidBody2D:
	return (tool as HeldBody).body if tool is HeldBody else null
