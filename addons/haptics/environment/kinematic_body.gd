@tool
extends "body_reader.gd"
## AnimatableBody2D, CharacterBody2D and frozen rigid bodies: they move and do not yield.


func kind() -> String:
	return "kinematic"
