@tool
@icon("res://addons/haptics/icons/haptic_wall_2d.svg")
class_name HapticWall2D
extends StaticBody2D
## A wall that can be felt: a StaticBody2D with a surface.
##
## Give it CollisionShape2D or CollisionPolygon2D children. A plain StaticBody2D can be felt too; it
## takes its surface from its metadata [code]haptic_surface[/code], else from the world.

## `tool` began to touch this wall.
signal touch_began(tool: HapticTool2D, contact: HapticContact)
## `tool` no longer touches it.
signal touch_ended(tool: HapticTool2D, contact: HapticContact)

const Warnings := preload("warnings.gd")
const Checks := preload("checks.gd")

## How it feels; without one, as the world's default surface.
@export var surface: HapticSurface

var _warnings := Warnings.new(self, Checks.of_body.bind(self))


func _notification(what: int) -> void:
	_warnings.follow(what)


## Pushes an error for every problem that was not told before.
func tell_problems() -> void:
	_warnings.say()


func _get_configuration_warnings() -> PackedStringArray:
	return _warnings.shown()
