@tool
@icon("res://addons/haptics/icons/haptic_linkage_2d.svg")
class_name HapticLinkage2D
extends Node2D
## Links tied together by joints: a door, an arm, a drawer, a chain. Held by any of its links it is
## the tool of a [HapticWorld2D]; left alone it moves by itself.
##
## Its [HapticLink2D] children and their HapticLink2D children are its links; a link's joint sits at
## its origin. The nodes follow the loop's newest report: do not move them, nor the linkage, while
## the world runs.

const LinkageReader := preload("../environment/linkage_reader.gd")
const Warnings := preload("warnings.gd")
const LinkageChecks := preload("linkage_checks.gd")
const FreeLinkage := preload("free_linkage.gd")

# after a start that failed, ticks until the next one
const _PAUSE := 60
# a copy that stands within this of where its coordinate says has not been put elsewhere, px and rad
const _SAME_PLACE := 1.0
const _SAME_ANGLE := 0.01

## Links directly below it are jointed to the scene. Else there is one of them and it is free in the
## plane.
@export var grounded: bool = true
## The link that a world without another tool holds first; without one the last.
@export var start_link: HapticLink2D
## Moves by itself while it is not held: swings, springs back, yields to what pushes it.
@export var moves_freely: bool = true

var _warnings := Warnings.new(self, LinkageChecks.of_linkage.bind(self))
# by instance id of the link; a link under another parent starts anew
var _rest: Dictionary[int, Transform2D] = {}
var _parents: Dictionary[int, int] = {}
var _coordinates: Dictionary[int, float] = {}
var _rates: Dictionary[int, float] = {}
var _base_velocity: PackedFloat64Array = [0.0, 0.0, 0.0]
var _free: FreeLinkage
var _wait := 0


func _notification(what: int) -> void:
	if what == NOTIFICATION_ENTER_TREE:
		add_to_group(LinkageReader.LINKAGES)
	if what == NOTIFICATION_EXIT_TREE:
		stop_free()
	if _free != null and (what == NOTIFICATION_PAUSED or what == NOTIFICATION_UNPAUSED):
		_free.set_paused(what == NOTIFICATION_PAUSED)
	_warnings.follow(what)


func _physics_process(delta: float) -> void:
	if Engine.is_editor_hint():
		return
	var world := HapticWorld2D.find_for(self)
	if world == null or not moves_freely or is_tool():
		stop_free()
		return
	if _free != null and not _free.is_current():
		stop_free()
	if _free == null and not _start_free(world):
		return
	_free.tick(delta)


func _process(_delta: float) -> void:
	_show_free()


# where the loop has it now, when nobody holds it
func _show_free() -> void:
	if _free != null and _free.is_current_run():
		_free.show()


## Its links, parents before their children.
func get_links() -> Array[HapticLink2D]:
	var links: Array[HapticLink2D] = []
	_collect(self, links)
	return links


## The link that is held first; null without links.
func get_start_link() -> HapticLink2D:
	var links := get_links()
	if start_link != null and start_link in links:
		return start_link
	return links[-1] if not links.is_empty() else null


## The hand lets go of what it holds and takes `link` at `point` (the link's axes, px). The force
## starts at zero. While the linkage is not the tool, the world changes its tool for it. False,
## after an error that says why, when it cannot.
func grab(link: HapticLink2D, point: Vector2) -> bool:
	var world := HapticWorld2D.find_for(self)
	if link == null or link.get_linkage() != self or world == null or not point.is_finite():
		push_error(
			(
				(
					"%s: grab() needs one of its own links and a finite point,"
					+ " in a scene with a HapticWorld2D; got %s, %s."
				)
				% [get_path(), link, point]
			)
		)
		return false
	link.grip_point = point
	return world.take(link)


## True while it is the tool of its world.
func is_tool() -> bool:
	var world := HapticWorld2D.find_for(self)
	var link := world.get_tool() as HapticLink2D if world != null else null
	return link != null and world.is_running() and link.get_linkage() == self


## The link that is held; null while none is.
func get_held_link() -> HapticLink2D:
	return HapticWorld2D.find_for(self).get_tool() as HapticLink2D if is_tool() else null


## Coordinate of the joint of `link` now: rad (clockwise) or m.
func get_coordinate(link: HapticLink2D) -> float:
	return _coordinates.get(link.get_instance_id(), 0.0) if link != null else 0.0


## How fast it changes: rad/s (clockwise) or m/s.
func get_rate(link: HapticLink2D) -> float:
	return _rates.get(link.get_instance_id(), 0.0) if link != null else 0.0


## Of the first link of one that floats: velocity of its center of mass (m/s) and angular velocity
## (rad/s), y up, the world node's axes.
func get_base_velocity() -> PackedFloat64Array:
	return _base_velocity


## The link of another linkage that it wrongly stands below; null in a sound scene.
func get_carrier() -> HapticLink2D:
	var above := get_parent()
	while above != null and not above is HapticLink2D:
		above = above.get_parent()
	return above as HapticLink2D


## What moves it while nobody holds it; null while it is held or does not move.
func get_mover() -> FreeLinkage:
	return _free


## It stands still, for what takes it over.
func stop_free() -> void:
	if _free != null:
		_free.stop()
	_free = null


## Pushes an error for every problem that was not told before.
func tell_problems() -> void:
	_warnings.say()


## Where `link` was drawn, against the link above it or against the linkage.
func get_rest(link: HapticLink2D) -> Transform2D:
	var key := link.get_instance_id()
	var above := link.get_parent().get_instance_id()
	# what was no place is looked at again
	if _parents.get(key, 0) != above or not _rest[key].is_finite():
		_parents[key] = above
		_rest[key] = link.transform
		_coordinates.erase(key)
		_rates.erase(key)
		_go_on_as_copied(link)
	return _rest[key]


## Where `link` was drawn, its coordinate and rate: for a copy of it. Empty when it has not moved.
func get_joint_state(link: HapticLink2D) -> Array:
	var key := link.get_instance_id()
	if not _coordinates.has(key) or _parents.get(key, 0) != link.get_parent().get_instance_id():
		return []
	return [_rest[key], _coordinates[key], _rates.get(key, 0.0)]


## Puts the links where the native side has them.
func place(states: PackedFloat64Array, units: HapticUnits) -> void:
	var links := get_links()
	if states.size() != links.size() * LinkageReader.STATE or not global_transform.is_finite():
		return
	for i: int in links.size():
		var at := i * LinkageReader.STATE
		var link := links[i]
		var key := link.get_instance_id()
		link.global_transform = units.pose_to_canvas(states[at], states[at + 1], states[at + 2])
		_coordinates[key] = states[at + 6] * LinkageReader.sign_of(link)
		_rates[key] = states[at + 7] * LinkageReader.sign_of(link)
	_base_velocity = states.slice(3, 6)


# A copy of a link that has moved stands at the same coordinate, unless it was put elsewhere.
func _go_on_as_copied(link: HapticLink2D) -> void:
	var state := link.take_copied_state()
	var world := HapticWorld2D.find_for(self)
	if state.size() != 3 or world == null or (not grounded and link.get_parent_link() == null):
		return
	var drawn: Transform2D = state[0]
	var coordinate: float = state[1]
	var stands := drawn
	if link.joint == HapticLink2D.Joint.REVOLUTE:
		stands = drawn.rotated_local(coordinate)
	elif link.joint == HapticLink2D.Joint.PRISMATIC:
		stands = drawn.translated_local(Vector2(coordinate * world.pixels_per_meter, 0.0))
	var turn := absf(angle_difference(stands.get_rotation(), link.transform.get_rotation()))
	if turn > _SAME_ANGLE or stands.origin.distance_to(link.transform.origin) > _SAME_PLACE:
		return
	var key := link.get_instance_id()
	_rest[key] = drawn
	_coordinates[key] = coordinate
	_rates[key] = state[2]


# its checks say why it does not move; what is wrong may be mended while the game runs
func _start_free(world: HapticWorld2D) -> bool:
	_wait -= 1
	if _wait > 0:
		return false
	var free := FreeLinkage.new(self, world)
	if get_carrier() != null or not free.start():
		_wait = _PAUSE
		_warnings.say()
		for link: HapticLink2D in get_links():
			link.tell_problems()
		return false
	_free = free
	_wait = 0
	return true


func _collect(above: Node, links: Array[HapticLink2D]) -> void:
	for child: Node in above.get_children():
		var link := child as HapticLink2D
		if link != null:
			links.append(link)
			_collect(link, links)


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
