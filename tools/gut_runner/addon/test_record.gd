extends RefCounted
## What happened in one test: its asserts, failures and time.

const PASSED := "passed"
const FAILED := "failed"
const PENDING := "pending"

var name: String = ""
## How many parameters the test function takes: 0, or 1 for a parameterized test.
var argument_count: int = 0
var passes: int = 0
var failures: PackedStringArray = []
var pending_texts: PackedStringArray = []
var orphans: int = 0
var seconds: float = 0.0


## How many asserts were made, passing or not.
func asserts() -> int:
	return passes + failures.size()


## The verdict. A test that asserted nothing has failed, unless it says that it is pending.
func status() -> String:
	if not failures.is_empty():
		return FAILED
	if not pending_texts.is_empty():
		return PENDING
	return PASSED if passes > 0 else FAILED


## All that the report needs, as plain data.
func to_dictionary() -> Dictionary:
	var messages: PackedStringArray = failures.duplicate()
	if messages.is_empty():
		messages = pending_texts.duplicate()
	if messages.is_empty() and passes == 0:
		messages.append("asserted nothing (use pass_test if that is meant)")
	return {
		"name": name,
		"status": status(),
		"asserts": asserts(),
		"messages": messages,
		"orphans": orphans,
		"seconds": seconds,
	}
