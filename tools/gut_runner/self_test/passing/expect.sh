exit_code=0
last='^35 passed, 0 failed$'
gut=same
