@tool
extends RefCounted
## What can be wrong with the nodes of a haptic scene, in words that name the value and the fix.
## The figures are judged by the native side, so that editor and game say the same.

const Gateway := preload("gateway.gd")
const BodyReader := preload("../environment/body_reader.gd")
const FixedBody := preload("../environment/fixed_body.gd")
const MovableBody := preload("../environment/movable_body.gd")
const ToolReader := preload("../environment/tool_reader.gd")
const LinkageChecks := preload("linkage_checks.gd")
const PlaceChecks := preload("place_checks.gd")
const WorldSettings := preload("world_settings.gd")
const Choices := preload("../resources/choices.gd")
const StartCheck := preload("../environment/start_check.gd")

const NO_WORLD := "There is no HapticWorld2D in this scene. Add one, or nothing can be felt."


## A wall or an object.
static func of_body(body: CollisionObject2D) -> PackedStringArray:
	if not body.is_inside_tree():
		return []
	if not body.global_transform.is_finite():
		return PlaceChecks.of(body)
	var world := HapticWorld2D.find_for(body)
	var units := HapticUnits.new()
	var problems := PackedStringArray()
	if world != null and not PlaceChecks.can_measure(world):
		# the world says it
		return []
	if world != null:
		units = HapticUnits.new(world.pixels_per_meter, world.global_transform)
	elif Engine.is_editor_hint():
		# a game may use its walls without haptics; there the tool says it
		problems.append(NO_WORLD)
	if not Gateway.is_available():
		return problems
	var reader: BodyReader
	if body is RigidBody2D:
		reader = MovableBody.new(body, 1, units)
	else:
		reader = FixedBody.new(body, 1, units)
	var description := reader.describe(world.default_surface if world != null else null)
	problems.append_array(reader.problems)
	if reader.is_switched_off():
		return problems
	problems.append_array(_without_twins(Gateway.new().set_body(1, description), reader.problems))
	return problems


## A rigid body: of_body, and what Godot would do to it.
static func of_object(body: RigidBody2D) -> PackedStringArray:
	var problems := of_body(body)
	if not body.is_inside_tree() or not body.global_transform.is_finite():
		return problems
	if not _is_unit(body.global_scale):
		problems.append(
			(
				"The scale is %s, which rigid bodies lose. Scale its shapes and pictures instead."
				% body.global_scale
			)
		)
	return problems


## The tool.
static func of_tool(tool: HapticTool2D) -> PackedStringArray:
	if tool is HapticLink2D:
		return LinkageChecks.of_link(tool as HapticLink2D)
	if not tool.is_inside_tree() or tool.get_shape_source() != tool:
		return []
	var world := HapticWorld2D.find_for(tool)
	if world == null:
		return [NO_WORLD]
	if not PlaceChecks.can_measure(world):
		return []
	var problems := Choices.problem("grip", tool.grip, HapticTool2D.Grip)
	var units := HapticUnits.new(world.pixels_per_meter, world.global_transform)
	if tool.global_transform.is_finite():
		problems.append_array(PlaceChecks.of_shape(tool))
	if world.get_tool() != tool and not world.get_tool() is HapticLink2D:
		problems.append(
			(
				"%s already has the tool %s; one world holds one tool. Remove one of them."
				% [world.name, world.get_tool().name]
			)
		)
	if tool.get_shape_owners().is_empty():
		problems.append(
			"The tool has no shape. Add a CollisionShape2D or CollisionPolygon2D as a child."
		)
		return problems
	var description := ToolReader.describe(tool, units, problems)
	if Gateway.is_available():
		var wrong := Gateway.new().set_tool(description)
		problems.append_array(_without_twins(wrong, problems))
	# once the loop moves it, it stands where it was put
	if not problems.is_empty() or world.is_running() and world.get_tool() == tool:
		return problems
	var wall := StartCheck.find_overlap(tool, _root_of(tool), StartCheck.slack(units))
	if wall != null:
		problems.append(
			(
				"It starts inside of %s, at %s. Move one of them: forces stay off until it is free."
				% [wall.name, tool.global_position.round()]
			)
		)
	for body: PhysicsBody2D in StartCheck.find_rays_alone(tool, _root_of(tool)):
		problems.append(
			(
				(
					"%s has no shape but SeparationRayShape2D, which has no surface to touch."
					+ " Give it another shape, or take it off the layers that the tool touches."
				)
				% body.name
			)
		)
	return problems


## The world, but for what its tool says itself.
static func of_world(world: HapticWorld2D) -> PackedStringArray:
	if not Gateway.is_available():
		# in a game the gateway says it
		return [Gateway.MISSING] if Engine.is_editor_hint() else []
	if not world.is_inside_tree():
		return []
	var first := HapticWorld2D.find_for(world)
	if first != world:
		return [
			(
				(
					"There are two haptic worlds in one World2D: %s and %s; %s does nothing."
					+ " Remove it, or put it into a SubViewport with a world of its own."
				)
				% [first.name, world.name, world.name]
			)
		]
	var problems := WorldSettings.problems_of(world)
	problems.append_array(PlaceChecks.of(world))
	if problems.is_empty() and not _is_unit(world.global_scale):
		(
			problems
			. append(
				(
					(
						"The world's scale is %s, which would change every force. Set it to 1 here and in"
						% world.global_scale
					)
					+ " its parents, and change pixels_per_meter instead."
				)
			)
		)
	if world.global_transform.is_finite() and not PlaceChecks.can_measure(world):
		problems.append(
			(
				"pixels_per_meter is %s, must lie between %s and %s; 4000 is usual."
				% [
					world.pixels_per_meter,
					PlaceChecks.LEAST_PIXELS_PER_METER,
					PlaceChecks.MOST_PIXELS_PER_METER
				]
			)
		)
	if world.get_tool() == null:
		problems.append("The world has no tool. Add a HapticTool2D with a collision shape.")
	var native := Gateway.new()
	problems.append_array(native.configure(world.to_settings()))
	if world.device == null:
		problems.append(
			"The world has no device. Set its device, to a HapticSimulatedPantograph for a start."
		)
	else:
		problems.append_array(world.device.get_problems(world.is_unattended()))
		problems.append_array(native.set_device(world.device.to_settings(world.is_unattended())))
	return problems


# "has no shape" once, not as an empty list of shapes too
static func _without_twins(
	problems: PackedStringArray, said: PackedStringArray
) -> PackedStringArray:
	if said.is_empty():
		return problems
	var left := PackedStringArray()
	for text: String in problems:
		if not "shapes is empty" in text:
			left.append(text)
	return left


static func _is_unit(scale: Vector2) -> bool:
	return scale.is_equal_approx(Vector2.ONE)


static func _root_of(node: Node) -> Node:
	var tree := node.get_tree()
	if Engine.is_editor_hint() and tree.edited_scene_root != null:
		return tree.edited_scene_root
	return tree.root
