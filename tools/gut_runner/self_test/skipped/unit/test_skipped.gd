extends GutTest
## Skipped and pending tests are counted apart.


func test_passes() -> void:
	assert_true(true)


func test_is_pending() -> void:
	pending("not written yet")


class TestSkipped:
	extends GutTest

	func should_skip_script() -> Variant:
		return "needs a device"

	func test_needs_a_device() -> void:
		fail_test("should not run")


class TestNotSkipped:
	extends GutTest

	func should_skip_script() -> Variant:
		return false

	func test_runs() -> void:
		assert_true(true)
