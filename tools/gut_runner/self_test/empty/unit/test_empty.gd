extends GutTest
## A file without a test.


func helper() -> void:
	pass
