extends RefCounted
## Rows of named values, written as CSV; what a row does not have stays empty.

## The file.
var path: String

var _columns: PackedStringArray
var _rows: Array[Dictionary] = []


func _init(file: String, columns: PackedStringArray) -> void:
	path = file
	_columns = columns


func add(row: Dictionary) -> void:
	_rows.append(row)


func size() -> int:
	return _rows.size()


## False when it could not be written.
func write() -> bool:
	var file := FileAccess.open(path, FileAccess.WRITE)
	if file == null:
		return false
	file.store_csv_line(_columns)
	for row: Dictionary in _rows:
		var line := PackedStringArray()
		for column: String in _columns:
			var value: Variant = row.get(column, "")
			line.append(String.num_scientific(value as float) if value is float else str(value))
		file.store_csv_line(line)
	return file.get_error() == OK
