extends GutTest
## Waits for what never comes.

signal never


func test_fine() -> void:
	assert_true(true)


func test_hangs() -> void:
	assert_true(true)
	await never
