extends GutTest


func test_fine() -> void:
	assert_true(true)
