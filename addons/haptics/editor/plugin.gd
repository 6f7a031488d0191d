@tool
extends EditorPlugin
## Wires the addon into the editor. Nodes and resources need no wiring: they are global classes.

const Gateway := preload("../nodes/gateway.gd")


func _enter_tree() -> void:
	HapticSettings.register()
	if not Gateway.is_available():
		push_warning(Gateway.MISSING)
