exit_code=1
last='^0 passed, [1-9] failed$'
mentions=('Godot ended with exit code 1[0-9][0-9]')
gut=same
