exit_code=1
last='^1 passed, [2-9] failed$'
mentions=('tests/unit/test_broken.gd does not parse' 'tests/unit/test_untyped.gd does not parse')
gut=same
gut_last='^1 passed, [0-9]+ failed$'
gut_mentions=('test_broken.gd' 'test_untyped.gd')
