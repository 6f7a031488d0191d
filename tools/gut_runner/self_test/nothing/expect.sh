exit_code=1
last='^0 passed, 1 failed$'
mentions=('no test ran')
gut=same
