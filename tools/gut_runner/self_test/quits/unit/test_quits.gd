extends GutTest
## Ends the process with code 0 before the suites are done.


func test_quits() -> void:
	assert_true(true)
	get_tree().quit(0)
	await wait_seconds(5.0)
