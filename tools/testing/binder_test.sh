#!/usr/bin/env bash
# Calls every kind of bound member of the binder's test classes from GDScript, headless, in a project of its own.
#   binder_test.sh [LIBRARY]     LIBRARY: the built haptics_binder_probe; else it is built in build/binder_probe
# Last line "N passed, N failed"; exit code 1 when a check failed, when none ran and when the engine ended badly.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# shellcheck source=stage_probe.sh
source "$root/tools/testing/stage_probe.sh"

mkdir -p "$root/build"
library=${1:-$(probe_library "$root/build/binder_probe")}
project=$(mktemp -d)
trap 'rm -rf "$project"' EXIT
stage_probe "$project" "$library"

log=$project/output.log
code=0
timeout 120 "$root/tools/godot" --headless --path "$project" -s res://test_binder.gd >"$log" 2>&1 || code=$?
grep -aE '^(FAILED|SCRIPT ERROR|Parse Error)|^ *at: .*\.gd:' "$log" || true
result=$(grep -aE '^[0-9]+ passed, [0-9]+ failed$' "$log" | tail -n 1 || true)

problem=
[[ $code -eq 0 ]] || problem="the engine ended with code $code"
[[ -n $result ]] || problem="no check ran"
grep -aqE 'leaked|still in use at exit' "$log" && problem="objects leaked at exit"
# levels come down in reverse, and the thread of the test singleton stops first
levels=$(grep -aE '^(initialize|terminate|unload)' "$log" | tr '\n' '|')
[[ $levels == 'initialize 2|initialize 3|unload: thread stopped, server alive|terminate 3|terminate 2|' ]] || problem="wrong order of levels: $levels"
if [[ -n $problem ]]; then
    cat "$log"
    echo "binder_test.sh: $problem"
    [[ -n $result && $result != "0 passed"* ]] || result="0 passed, 0 failed"
    echo "$result" | awk '{ print $1 " passed, " $3 + 1 " failed" }'
    exit 1
fi
echo "$result"
