arguments=(--timeout=30)
exit_code=1
last='^0 passed, [1-9] failed$'
mentions=('took too long and was stopped.*test_is_busy_for_ever')
gut=same
gut_mentions=('took too long and was stopped')
