exit_code=1
last='^0 passed, [1-9] failed$'
mentions=('ended without results')
gut=same
