@tool
extends RefCounted
## Which surface a body has: its property, else its metadata, else the world's default. (Tiles have
## theirs in a custom data layer of the same name; see tile_layer.gd.)

## Name of the property of scripts that are not ours, of the metadata, and of the tiles' custom
## data layer.
const NAME := &"haptic_surface"

# of our own nodes, and of others
const _PROPERTIES: Array[StringName] = [&"surface", NAME]


## The surface of `body`, never null.
static func find(body: Node, fallback: HapticSurface) -> HapticSurface:
	var own := find_own(body)
	if own != null:
		return own
	return fallback if fallback != null else HapticSurface.new()


## The surface that `body` brings along; null without one.
static func find_own(body: Node) -> HapticSurface:
	for property: StringName in _PROPERTIES:
		var own: Variant = body.get(property)
		if own is HapticSurface:
			return own
	if not body.has_meta(NAME):
		return null
	var noted: Variant = body.get_meta(NAME)
	return noted as HapticSurface if noted is HapticSurface else null
