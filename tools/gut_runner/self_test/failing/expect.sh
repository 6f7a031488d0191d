exit_code=1
last='^0 passed, 63 failed$'
# file and line of the failing assert, and of one behind an await
mentions=('tests/unit/test_asserts.gd:10: 1 expected to equal 2' 'params\[1\] 2 expected to differ from 2')
gut=same
gut_mentions=('at line 10')
