extends RefCounted
## Small linkages built in code, shared by the suites.

const Scene := preload("res://tests/support/haptic_scene.gd")


## A bar of `size` px that begins at the link's origin and lies along its x axis.
static func make_link(called: String, size: Vector2, mass: float = 0.1) -> HapticLink2D:
	var link := HapticLink2D.new()
	link.name = called
	link.mass = mass
	link.center_of_mass = Vector2(size.x / 2.0, 0.0)
	link.grip_point = Vector2(size.x, 0.0)
	link.add_child(Scene.make_box(size, Vector2(size.x / 2.0, 0.0)))
	return link


## A chain of such bars, each jointed to the end of the one before; the first at `position`.
static func make_chain(count: int, size: Vector2, position := Vector2.ZERO) -> HapticLinkage2D:
	var linkage := HapticLinkage2D.new()
	linkage.name = "Linkage"
	linkage.position = position
	var above: Node2D = linkage
	for i: int in count:
		var link := make_link("Link%d" % (i + 1), size)
		if i > 0:
			link.position = Vector2(size.x, 0.0)
			link.rotation = 0.5
		above.add_child(link)
		above = link
	return linkage


## Size of a link of make_link().
static func size_of(link: HapticLink2D) -> Vector2:
	return ((link.get_node("Shape") as CollisionShape2D).shape as RectangleShape2D).size


## A round tool of 0.3 kg.
static func make_ball(position: Vector2, radius: float) -> HapticTool2D:
	var tool := HapticTool2D.new()
	tool.name = "Tool"
	tool.position = position
	tool.mass = 0.3
	var shape := CollisionShape2D.new()
	shape.name = "Shape"
	var circle := CircleShape2D.new()
	circle.radius = radius
	shape.shape = circle
	tool.add_child(shape)
	return tool


## The paper's surface with much friction.
static func make_rough() -> HapticSurface:
	var surface := HapticSurface.new()
	surface.static_friction = 1.0
	surface.dynamic_friction = 1.0
	return surface
