exit_code=1
last='^0 passed, [1-9] failed$'
mentions=('tests/unit/test_empty.gd has no test')
gut=same
gut_mentions=('test_empty.gd yielded no test')
