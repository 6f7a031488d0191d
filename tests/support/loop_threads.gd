extends RefCounted
## Threads of this process that run a haptic loop, by the name that the system knows them by.

const _NAME := "haptic-loop"


static func count() -> int:
	var loops := 0
	for task: String in DirAccess.get_directories_at("/proc/self/task"):
		var file := FileAccess.open("/proc/self/task/%s/comm" % task, FileAccess.READ)
		# one that just ended has no file any more
		if file != null and file.get_line().strip_edges() == _NAME:
			loops += 1
	return loops
