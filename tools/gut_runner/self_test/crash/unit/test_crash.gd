extends GutTest
## Takes the process down.


func test_crashes() -> void:
	assert_true(true)
	OS.crash("on purpose")
