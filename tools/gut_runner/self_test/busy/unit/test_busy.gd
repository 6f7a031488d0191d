extends GutTest
## Never comes back.


func test_is_busy_for_ever() -> void:
	var count: int = 0
	while count >= 0:
		count = 1
	assert_true(true)
