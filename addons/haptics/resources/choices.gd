@tool
extends RefCounted
## Names of choices for the native side. A file or a script can hold a number that is no choice: its
## digits are handed over, and the native side refuses them by property, value and fix.


## Name number `choice` of `names`.
static func name_of(names: PackedStringArray, choice: int) -> String:
	return names[choice] if choice >= 0 and choice < names.size() else str(choice)


## What is wrong with the `choice` of `property`, in words; empty when it is one of `choices` (an
## enum).
static func problem(property: String, choice: int, choices: Dictionary) -> PackedStringArray:
	if choice in choices.values():
		return []
	return ["%s is %d, must be one of: %s." % [property, choice, ", ".join(choices.keys())]]
