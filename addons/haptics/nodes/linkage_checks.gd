@tool
extends RefCounted
## What can be wrong with a linkage and its links, in words that name the value and the fix.

const Gateway := preload("gateway.gd")
const LinkageReader := preload("../environment/linkage_reader.gd")
const PlaceChecks := preload("place_checks.gd")
const Choices := preload("../resources/choices.gd")

# a spring that rests farther away never comes to rest, rad or m
const _FARTHEST_REST := 1e4


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
	if not linkage.global_transform.is_finite():
		return problems + PlaceChecks.of(linkage)
	problems.append_array(PlaceChecks.of_shape(linkage))
	# the links say it
	if links.any(func(l: HapticLink2D) -> bool: return not _of_joint(l).is_empty()):
		return problems
	if not Gateway.is_available() or not PlaceChecks.can_measure(world):
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
	# the linkage says it of itself
	if link.get_linkage().global_transform.is_finite():
		problems.append_array(_of_joint(link))
	return problems


# the figures that the native side sees turned about, or not at all
static func _of_joint(link: HapticLink2D) -> PackedStringArray:
	var problems := Choices.problem("joint", link.joint, HapticLink2D.Joint)
	var rest := link.get_linkage().get_rest(link)
	if not rest.is_finite():
		problems.append(
			(
				"It stands at %s, turned by %s rad, which is no place. Give it a real one."
				% [link.position, link.rotation]
			)
		)
	elif not rest.get_scale().is_equal_approx(Vector2.ONE) or not is_zero_approx(rest.get_skew()):
		(
			problems
			. append(
				(
					"The scale is %s and the skew %s rad. Set them to 1 and 0, and change the shapes instead."
					% [rest.get_scale(), rest.get_skew()]
				)
			)
		)
	if link.joint == HapticLink2D.Joint.FIXED:
		return problems
	if not absf(link.spring_rest) <= _FARTHEST_REST:
		problems.append(
			(
				"spring_rest is %s, must lie within %s either way. 0 is where the scene drew it."
				% [link.spring_rest, _FARTHEST_REST]
			)
		)
	if not link.has_limits:
		return problems
	for limit: StringName in [&"lower_limit", &"upper_limit"]:
		if is_nan(link.get(limit) as float):
			problems.append("%s is nan. Give it a number, or take has_limits away." % limit)
	if link.lower_limit >= link.upper_limit:
		problems.append(
			(
				"lower_limit is %s and upper_limit %s. Make the lower one smaller."
				% [link.lower_limit, link.upper_limit]
			)
		)
	return problems


# "links[2].mass is 0" and "link 2" name no node, "joint.damping" no property
static func _with_names(text: String, links: Array[HapticLink2D]) -> String:
	for i: int in range(links.size() - 1, -1, -1):
		text = text.replace("joint.damping", "joint_damping").replace(
			"joint.friction", "joint_friction"
		)
		text = text.replace("joint.limit_", "limit_").replace("joint.spring_", "spring_")
		text = text.replace("links[%d]." % i, "%s." % links[i].name)
		text = text.replace("link %d " % i, "%s " % links[i].name)
		text = text.replace("link %d:" % i, "%s:" % links[i].name)
	return text
