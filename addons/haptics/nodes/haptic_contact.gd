@tool
class_name HapticContact
extends RefCounted
## One place where the tool touches something.

## What a contact does.
enum State {
	## It opened.
	NONE,
	## It closed in this very step.
	COLLIDING,
	## It holds by friction.
	STICKING,
	## It slides.
	SLIDING,
}

const _STATES: Dictionary[String, State] = {
	"none": State.NONE,
	"colliding": State.COLLIDING,
	"sticking": State.STICKING,
	"sliding": State.SLIDING,
}

## What is touched, a body or a TileMapLayer; null when it is gone.
var body: Node2D
## What the contact does.
var state: State = State.NONE
## Where, on the canvas, px.
var position: Vector2
## Direction out of what is touched, on the canvas.
var normal: Vector2
## Force of the surface on the tool, on the canvas, N.
var force: Vector2
## Its part along the normal, N, 0 or more.
var normal_force: float
## Its part along the surface, N, above 0 where it points to the left of the normal.
var tangent_force: float
## Deepest overlap, m.
var penetration: float
## When it happened, on the loop's clock, s (of contacts in signals).
var time: float


## The cell that is touched, of a TileMapLayer.
func get_cell() -> Vector2i:
	var layer := body as TileMapLayer
	if layer == null:
		return Vector2i.ZERO
	# a little inside of it
	return layer.local_to_map(layer.to_local(position - normal * 0.5))


## From what the native side reports.
static func from_report(report: Dictionary, units: HapticUnits, touched: Node2D) -> HapticContact:
	var contact := HapticContact.new()
	var at: PackedFloat64Array = report["position"]
	var out: PackedFloat64Array = report["normal"]
	contact.body = touched
	contact.position = units.point_to_canvas(at[0], at[1])
	contact.normal = units.vector_to_canvas(out[0], out[1])
	contact.state = _STATES.get(report.get("state", "none"), State.NONE)
	contact.normal_force = report.get("normal_force", 0.0)
	contact.tangent_force = report.get("tangent_force", 0.0)
	contact.force = units.vector_to_canvas(
		out[0] * contact.normal_force - out[1] * contact.tangent_force,
		out[1] * contact.normal_force + out[0] * contact.tangent_force
	)
	contact.penetration = report.get("penetration", 0.0)
	contact.time = report.get("time", 0.0)
	return contact
