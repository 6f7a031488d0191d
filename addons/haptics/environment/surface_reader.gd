@tool
extends RefCounted
## Which surface a body has: its property, else its metadata, else the world's default.

## Name of the property and of the metadata.
const NAME := &"haptic_surface"


## The surface of `body`, never null.
static func find(body: Node, fallback: HapticSurface) -> HapticSurface:
	var own: Variant = body.get(&"surface")
	if own is HapticSurface:
		return own
	if body.has_meta(NAME):
		var noted: Variant = body.get_meta(NAME)
		if noted is HapticSurface:
			return noted
	return fallback if fallback != null else HapticSurface.new()
