#!/usr/bin/env bash
# Ends a game while its loop pushes a hand against a wall, again and again: it quits in a frame, in a tick and on a request to close,
# and is killed as the editor's stop button kills it. It has to end at once and well, without force, thread or process behind.
#   quit_test.sh [ROUNDS]     default 20, four at a time
# Last line "N passed, N failed"; exit code 1 when a round failed.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
rounds=${1:-20}
ways=(process physics close killed terminated)
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

# one ROUND: an empty line, or what was wrong
one() {
    local way=${ways[$(($1 % ${#ways[@]}))]} log=$logs/$1.log signal='' code=0
    case $way in killed) signal=KILL ;; terminated) signal=TERM ;; esac
    timeout --kill-after=5 120 "$root/tools/godot" --headless --path "$root" -s res://tools/testing/quit_probe.gd -- \
        "$([[ -n $signal ]] && echo never || echo "$way")" >"$log" 2>&1 </dev/null &
    local waiter=$! game=''
    if [[ -n $signal ]]; then
        until grep -qs '^pushing$' "$log" || ! kill -0 "$waiter" 2>/dev/null; do sleep 0.05; done
        game=$(pgrep -P "$waiter" | head -n 1)
        [[ -z $game ]] || kill -s "$signal" "$game"
    fi
    wait "$waiter" || code=$?
    if ! grep -q '^pushing$' "$log"; then
        echo "$way: the hand never felt the wall" && tail -n 5 "$log" && return
    fi
    if grep -aE 'ERROR|WARNING|leaked|handle_crash' "$log"; then echo "$way: the engine complained"; fi
    if [[ -n $signal ]]; then
        [[ $code -eq 137 || $code -eq 143 ]] || echo "$way: ended with code $code"
        [[ -z $game || ! -e /proc/$game/task ]] || echo "$way: the process is still there"
        return
    fi
    [[ $code -eq 0 ]] || echo "$way: ended with code $code"
    grep -q '^left: 0 loops, force \[0.0, 0.0, 0.0\]$' "$log" || echo "$way: $(grep '^left' "$log" || echo 'the world did not stop')"
}

passed=0 failed=0
for ((round = 0; round < rounds; round += 4)); do
    for ((i = round; i < round + 4 && i < rounds; ++i)); do one "$i" >"$logs/$i.result" & done
    wait
    for ((i = round; i < round + 4 && i < rounds; ++i)); do
        if [[ -s $logs/$i.result ]]; then
            failed=$((failed + 1)) && cat "$logs/$i.result"
        else
            passed=$((passed + 1))
        fi
    done
done
echo "$passed passed, $failed failed"
[[ $failed -eq 0 && $passed -gt 0 ]]
