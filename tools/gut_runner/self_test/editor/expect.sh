exit_code=1
last='^1 passed, 2 failed$'
mentions=('in the editor')
gut=same
