@tool
@icon("res://addons/haptics/icons/haptic_object_2d.svg")
class_name HapticObject2D
extends RigidBody2D
## A thing that can be felt and pushed, and that pushes back: a RigidBody2D with a surface.
##
## Its mass, inertia, velocity and collisions with other bodies are Godot's; what the tool does to
## it is computed in the haptic loop and handed to Godot at every physics tick. A planar device lies
## flat: set gravity_scale to 0, or the world's gravity_source to match Godot's gravity.

## `tool` began to touch this object.
signal touch_began(tool: HapticTool2D, contact: HapticContact)
## `tool` no longer touches it.
signal touch_ended(tool: HapticTool2D, contact: HapticContact)

const Warnings := preload("warnings.gd")
const Checks := preload("checks.gd")

## How it feels; without one, as the world's default surface.
@export var surface: HapticSurface

var _warnings := Warnings.new(self, Checks.of_object.bind(self))


func _notification(what: int) -> void:
	_warnings.follow(what)


## Pushes an error for every problem that was not told before.
func tell_problems() -> void:
	_warnings.say()


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
