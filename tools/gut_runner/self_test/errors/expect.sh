exit_code=1
last='^1 passed, 11 failed$'
mentions=('nobody expected this \[res://tests/unit/test_errors.gd:7\]' 'from afar' 'asserted nothing')
gut=same
gut_mentions=('nobody expected this' 'no asserts')
