@tool
extends RefCounted
## Reads a linkage into what the native side takes as a tool.
##
## Angles of the native side are y up: a joint that turns clockwise by q here has the coordinate -q
## there. Distances along a link's x axis are the same.

## Group of all linkages.
const LINKAGES := &"haptic_linkages"

const ShapeReader := preload("shape_reader.gd")
const ToolReader := preload("tool_reader.gd")

## Numbers of a link in what the native side tells: pose of its node, velocity of its center of
## mass, coordinate and its rate.
const STATE := 8

const _JOINTS: Dictionary[HapticLink2D.Joint, String] = {
	HapticLink2D.Joint.REVOLUTE: "revolute",
	HapticLink2D.Joint.PRISMATIC: "prismatic",
	HapticLink2D.Joint.FIXED: "fixed",
}


## `held` is the link that the hand holds; `problems` is added to.
static func describe(
	linkage: HapticLinkage2D, held: HapticLink2D, units: HapticUnits, problems: PackedStringArray
) -> Dictionary:
	var links := linkage.get_links()
	var described: Array[Dictionary] = []
	for link: HapticLink2D in links:
		described.append(_describe_link(linkage, link, links, units, problems))
	var description := {
		"grounded": linkage.grounded,
		"links": described,
		"grip_link": links.find(held),
		"grip_point": units.local_to_meters(held.grip_point),
		"grip_pose": held.hold_angle,
	}
	if not linkage.grounded and not links.is_empty():
		description["base"] = units.pose_to_meters(links[0].global_transform)
		description["base_velocity"] = linkage.get_base_velocity()
	return description


## 1 where a coordinate here is the one of the native side, -1 where it is its opposite.
static func sign_of(link: HapticLink2D) -> float:
	return -1.0 if link.joint == HapticLink2D.Joint.REVOLUTE else 1.0


## What the linkage is made of, without where it is: changes when somebody changes it.
static func signature(linkage: HapticLinkage2D, units: HapticUnits) -> int:
	var links := linkage.get_links()
	if links.is_empty():
		return 0
	var description := describe(linkage, links[-1], units, PackedStringArray())
	for link: Dictionary in description["links"]:
		link.erase("coordinate")
		link.erase("rate")
	description.erase("base")
	description.erase("base_velocity")
	return description.hash()


## Where to look around: a disc (canvas: x, y, radius in px) for every link. `states` are those of
## the native side; `distance` takes extent and speed of a link (m, m/s) and gives its reach (m).
static func reach(
	linkage: HapticLinkage2D, states: PackedFloat64Array, units: HapticUnits, distance: Callable
) -> Array[Vector3]:
	var discs: Array[Vector3] = []
	var links := linkage.get_links()
	if states.is_empty() or states.size() % links.size() != 0:
		return discs
	@warning_ignore("integer_division")
	var stride := states.size() / links.size()
	for i: int in links.size():
		var at := i * stride
		var link := links[i]
		var place := units.point_to_canvas(states[at], states[at + 1])
		var lever := units.to_meters(link.center_of_mass.length())
		var speed := Vector2(states[at + 3], states[at + 4]).length()
		speed += absf(states[at + 5]) * lever
		var far: float = distance.call(units.to_meters(ToolReader.extent(link)), speed)
		discs.append(Vector3(place.x, place.y, units.to_pixels(far)))
	return discs


static func _describe_link(
	linkage: HapticLinkage2D,
	link: HapticLink2D,
	links: Array[HapticLink2D],
	units: HapticUnits,
	problems: PackedStringArray
) -> Dictionary:
	var reader := ShapeReader.new(units)
	reader.read(link, Transform2D.IDENTITY)
	for text: String in reader.problems:
		problems.append("%s: %s" % [link.name, text])
	var body := {
		"kind": "tool",
		"mass": link.mass,
		"density": link.density,
		"inertia": link.inertia,
		"center": units.local_to_meters(link.center_of_mass),
		"rounding": link.rounding,
		"shapes": reader.shapes,
	}
	if link.surface != null:
		body["surface"] = link.surface.to_settings()
	var turn := sign_of(link)
	var rest := linkage.get_rest(link)
	var frame: PackedFloat64Array
	if link.get_parent_link() == null:
		frame = units.pose_to_meters(linkage.global_transform * rest)
	else:
		frame = units.local_to_meters(rest.origin)
		frame.append(-rest.get_rotation())
	var described := {
		"parent": links.find(link.get_parent_link()),
		"joint": _JOINTS.get(link.joint, str(link.joint)),
		"frame": frame,
		"coordinate": linkage.get_coordinate(link) * turn,
		"rate": linkage.get_rate(link) * turn,
		"limit_stiffness": link.limit_stiffness,
		"limit_damping": link.limit_damping,
		"damping": link.joint_damping,
		"friction": link.joint_friction,
		"spring_stiffness": link.spring_stiffness,
		"spring_rest": link.spring_rest * turn,
		"body": body,
	}
	if link.has_limits:
		var ends := PackedFloat64Array([link.lower_limit * turn, link.upper_limit * turn])
		if turn < 0.0:
			ends.reverse()
		described["limits"] = ends
	return described
