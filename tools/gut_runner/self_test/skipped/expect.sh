exit_code=0
last='^2 passed, 0 failed, 2 skipped$'
mentions=('needs a device' 'not written yet')
gut=same
