export GUT_RUNNER_TEST_SECONDS=1
exit_code=1
last='^1 passed, [1-9] failed$'
mentions=('test_hang.gd::test_hangs did not finish in 1')
