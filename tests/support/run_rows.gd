extends RefCounted
## What the loop of a world recorded, one row a haptic step.

## The force (N) that left for the hand may change by this part of itself in a step, or by so many
## newtons: a tenth to a fourteenth of a force is what fingers just notice.
const FEELABLE := 0.07
const FEELABLE_AT_LEAST := 0.05

var _rows: Array[PackedFloat64Array] = []
var _columns: Dictionary[String, int] = {}
var _step := 0.001


## Of a world that records; errors of saving are the engine's.
static func of(world: HapticWorld2D) -> RefCounted:
	var rows := new()
	rows._read(world)
	return rows


## Number of steps with `from` < time <= `to`, s of the loop's clock.
func count(from: float, to: float) -> int:
	var steps := 0
	for row: PackedFloat64Array in _rows:
		steps += 1 if row[0] > from and row[0] <= to else 0
	return steps


## Largest force on the hand between the two times, N.
func largest_force(from: float, to: float) -> float:
	var largest := 0.0
	for row: PackedFloat64Array in _rows:
		if row[0] > from and row[0] <= to:
			largest = maxf(largest, _force(row).length())
	return largest


## Smallest force on the hand between the two times, N.
func smallest_force(from: float, to: float) -> float:
	var smallest := INF
	for row: PackedFloat64Array in _rows:
		if row[0] > from and row[0] <= to:
			smallest = minf(smallest, _force(row).length())
	return smallest


## The mean of a column between the two times.
func mean(column: String, from: float, to: float) -> float:
	var sum := 0.0
	var steps := 0
	for row: PackedFloat64Array in _rows:
		if row[0] > from and row[0] <= to:
			sum += row[_columns[column]]
			steps += 1
	return sum / maxi(steps, 1)


## The mean size of the force on the hand between the two times, N.
func mean_force(from: float, to: float) -> float:
	var sum := 0.0
	for row: PackedFloat64Array in _rows:
		if row[0] > from and row[0] <= to:
			sum += _force(row).length()
	return sum / maxi(count(from, to), 1)


## The worst change of force from one step to the next between the two times, over what may change
## at the force `scale` (N; 0: at the force of the moment), and when: (ratio, time). A loop that was
## late leaves steps out; the change is then that of several steps, and counts as such.
func worst_jump(from: float, to: float, scale: float = 0.0) -> Vector2:
	var worst := Vector2.ZERO
	for i: int in range(1, _rows.size()):
		var row := _rows[i]
		if row[0] <= from or row[0] > to:
			continue
		var before := _force(_rows[i - 1])
		var steps := maxf(roundf((row[0] - _rows[i - 1][0]) / _step), 1.0)
		var size := scale if scale > 0.0 else before.length()
		var allowed := steps * maxf(FEELABLE * size, FEELABLE_AT_LEAST)
		var ratio := (_force(row) - before).length() / allowed
		if ratio > worst.x:
			worst = Vector2(ratio, row[0])
	return worst


## The largest change of force from one step to the next between the two times, N.
func largest_change(from: float, to: float) -> float:
	var largest := 0.0
	for i: int in range(1, _rows.size()):
		var row := _rows[i]
		if row[0] > from and row[0] <= to:
			var steps := maxf(roundf((row[0] - _rows[i - 1][0]) / _step), 1.0)
			largest = maxf(largest, (_force(row) - _force(_rows[i - 1])).length() / steps)
	return largest


func _force(row: PackedFloat64Array) -> Vector2:
	var x := _columns["force_x_n"]
	return Vector2(row[x], row[x + 1])


func _read(world: HapticWorld2D) -> void:
	_step = 1.0 / world.rate
	var path := OS.get_user_data_dir().path_join("rows_%d.csv" % world.get_instance_id())
	if world.save_recording(path) != OK:
		return
	var file := FileAccess.open(path, FileAccess.READ)
	var names := file.get_line().split(",")
	for i: int in names.size():
		_columns[names[i]] = i
	while not file.eof_reached():
		var row := file.get_line().split_floats(",", false)
		if row.size() == names.size():
			_rows.append(row)
	file.close()
	DirAccess.remove_absolute(path)
