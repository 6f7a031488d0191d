@tool
extends RefCounted
## What can be wrong with a linkage and its links, in words that name the value and the fix.

const Gateway := preload("gateway.gd")
const LinkageReader := preload("../environment/linkage_reader.gd")


## The linkage as a whole: also what the native side finds wrong with a link, by the link's name.
static func of_linkage(linkage: HapticLinkage2D) -> PackedStringArray:
	if not linkage.is_inside_tree():
		return []
	var problems := PackedStringArray()
	var links := linkage.get_links()
	if linkage.get_carrier() != null:
		return [
			(
				"It stands below the link %s. Move it out: make its links children of that link instead."
				% linkage.get_carrier().name
			)
		]
	if links.is_empty():
		return ["It has no links. Add a HapticLink2D with a collision shape as a child."]
	var roots := links.filter(func(l: HapticLink2D) -> bool: return l.get_parent_link() == null)
	if not linkage.grounded and roots.size() > 1:
		return [
			(
				(
					"It floats, but %d links stand directly below it: %s is the second."
					+ " Nest them below the first, or set grounded."
				)
				% [roots.size(), (roots[1] as HapticLink2D).name]
			)
		]
	if linkage.start_link != null and not linkage.start_link in links:
		problems.append(
			(
				"start_link is %s, which is none of its links. Choose one of them."
				% linkage.start_link.name
			)
		)
	var world := HapticWorld2D.find_for(linkage)
	if world == null:
		return problems + PackedStringArray(["There is no HapticWorld2D in this scene. Add one."])
	if not linkage.global_scale.is_equal_approx(Vector2.ONE):
		problems.append(
			"The scale is %s. Set it to 1 and scale the shapes instead." % linkage.global_scale
		)
	if not Gateway.is_available() or world.pixels_per_meter <= 0.0:
		return problems
	var units := HapticUnits.new(world.pixels_per_meter, world.global_transform)
	var description := LinkageReader.describe(linkage, links[-1], units, problems)
	if problems.is_empty():
		for text: String in Gateway.new().set_tool(description):
			problems.append(_with_names(text, links))
	return problems


## A link by itself; its figures are told by the linkage.
static func of_link(link: HapticLink2D) -> PackedStringArray:
	if not link.is_inside_tree():
		return []
	if link.get_linkage() == null:
		return [
			(
				"It stands below %s, which is no HapticLinkage2D. Make it a child of one, or of another link."
				% link.get_parent().name
			)
		]
	var problems := PackedStringArray()
	if link.get_shape_owners().is_empty():
		problems.append(
			"The link has no shape. Add a CollisionShape2D or CollisionPolygon2D as a child."
		)
	if link.has_limits and link.lower_limit >= link.upper_limit:
		problems.append(
			(
				"lower_limit is %s and upper_limit %s. Make the lower one smaller."
				% [link.lower_limit, link.upper_limit]
			)
		)
	return problems


# "links[2].mass is 0" and "link 2" name no node
static func _with_names(text: String, links: Array[HapticLink2D]) -> String:
	for i: int in range(links.size() - 1, -1, -1):
		text = text.replace("links[%d]." % i, "%s." % links[i].name)
		text = text.replace("link %d " % i, "%s " % links[i].name)
		text = text.replace("link %d:" % i, "%s:" % links[i].name)
	return text
