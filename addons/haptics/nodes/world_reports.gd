@tool
extends RefCounted
## What a world tells its user in words.


## Pushes an error for each of these under the name of `node`. FAILED when there are any.
static func say(node: Node, problems: PackedStringArray) -> Error:
	for text: String in problems:
		push_error("%s: %s" % [node.get_path(), text])
	return OK if problems.is_empty() else FAILED


## A line for every stage of the haptic step, from the statistics of a run.
static func plan_of(statistics: Dictionary) -> PackedStringArray:
	var lines := PackedStringArray()
	for stage: Dictionary in statistics.get("plan", []):
		var reason: String = stage["reason"]
		lines.append(
			"%s: %s" % [stage["stage"], "runs" if stage["runs"] else "left out, %s" % reason]
		)
	return lines
