@tool
extends "body_reader.gd"
## HapticLink2D of a linkage that runs beside the tool: the linkage moves it, the tool pushes it and
## it pushes back as its joints let it.

const FreeLinkage := preload("../nodes/free_linkage.gd")

var _yields := false


func kind() -> String:
	return "movable" if _mover() != null else "kinematic"


func describe(fallback: HapticSurface) -> Dictionary:
	var link := node as HapticLink2D
	var description := super.describe(fallback)
	description["mask"] = link.collision_mask
	description["mass"] = link.mass
	description["density"] = link.density
	description["inertia"] = link.inertia
	description["center"] = _units.local_to_meters(link.center_of_mass)
	description["rounding"] = link.rounding
	return description


func read_state(tick: int, seconds: float) -> PackedFloat64Array:
	var mover := _mover()
	# its linkage was taken, let go or started: until it is described anew it would not yield
	if (mover != null) != _yields:
		_yields = mover != null
		is_dirty = true
	if mover == null:
		return super.read_state(tick, seconds)
	_state = mover.state_of(node as HapticLink2D) + PackedFloat64Array([0.0, 0.0])
	_seen_at = node.global_transform
	_tick = tick
	return _state


# what the tool gives it the linkage has already: both run in one loop
func tie(native: Gateway) -> void:
	var mover := _mover()
	if mover != null:
		mover.tie(native, id, node as HapticLink2D)


func _mover() -> FreeLinkage:
	var linkage := (node as HapticLink2D).get_linkage()
	var mover := linkage.get_mover() if linkage != null else null
	return mover if mover != null and mover.is_beside_tool() else null


func _features() -> Array:
	var link := node as HapticLink2D
	return super._features() + [link.mass, link.density, link.inertia, link.center_of_mass]
