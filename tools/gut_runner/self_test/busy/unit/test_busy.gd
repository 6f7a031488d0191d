extends GutTest
## Never comes back. It sleeps meanwhile, so that it does not slow down what runs beside it.


func test_is_busy_for_ever() -> void:
	var count: int = 0
	while count >= 0:
		OS.delay_msec(50)
	assert_true(true)
