#!/usr/bin/env bash
# Rebuilds a library with another constant and reloads it in a running headless editor, again and again, in a project of its own:
# new code has to run each time, objects have to live on, and a thread of the library has to stop before it goes.
#   hot_reload_test.sh [ROUNDS]     default 20
# Last line "N passed, N failed"; exit code 1 when a round failed or the editor ended badly.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# shellcheck source=stage_probe.sh
source "$root/tools/testing/stage_probe.sh"
rounds=${1:-20}
build=$root/build/binder_probe

# one run at a time in that build folder
mkdir -p "$build"
exec 8>"$build.lock"
flock 8

generation() {
    printf 'extern const long probe_generation;\nconst long probe_generation = %d;\n' "$1" \
        >"$build/native/tests/binder/probe_generation.cpp"
}
mkdir -p "$build/native/tests/binder"
generation 0
library=$(probe_library "$build")

project=$(mktemp -d)
editor=
finish() {
    [[ -z $editor ]] || kill "$editor" 2>/dev/null || true
    rm -rf "$project"
}
trap finish EXIT
stage_probe "$project" "$library"
mkdir -p "$project/addons/reload"
mv "$project"/reload_plugin.gd "$project"/plugin.cfg "$project/addons/reload/"
printf '\n[editor_plugins]\n\nenabled=PackedStringArray("res://addons/reload/plugin.cfg")\n' >>"$project/project.godot"

log=$project/editor.log
timeout $((120 + 20 * rounds)) "$root/tools/godot" --headless --editor --path "$project" 8>&- >"$log" 2>&1 &
editor=$!

passed=0
problem=
# the plugin answers "generation N ok" in a file, or says what is wrong
answer() {
    local wait=0
    until [[ -e $project/answer_$1.txt ]]; do
        kill -0 "$editor" 2>/dev/null || { echo "the editor is gone" && return; }
        ((++wait <= 600)) || { echo "no answer" && return; }
        sleep 0.1
    done
    cat "$project/answer_$1.txt"
}

for ((round = 0; round <= rounds; ++round)); do
    if ((round > 0)); then
        generation "$round"
        install_library "$(probe_library "$build")" "$project"
        touch "$project/ask_$round.tmp"
        mv "$project/ask_$round.tmp" "$project/ask_$round.txt"
    fi
    said=$(answer "$round")
    if [[ $said != "generation $round ok" ]]; then
        problem="round $round: $said"
        break
    fi
    ((round == 0)) || passed=$((passed + 1))
done

touch "$project/ask_quit.txt"
if [[ -z $problem ]]; then
    code=0
    wait "$editor" || code=$?
    editor=
    [[ $code -eq 0 ]] || problem="the editor ended with code $code"
    stops=$(grep -ac '^unload: thread stopped, server alive$' "$log" || true)
    [[ $stops -eq $((rounds + 1)) ]] || problem="the thread was stopped $stops times, expected $((rounds + 1))"
    grep -aE 'ERROR|leaked|handle_crash' "$log" && problem="the editor reported an error"
fi
if [[ -n $problem ]]; then
    tail -n 40 "$log"
    echo "hot_reload_test.sh: $problem"
    echo "$passed passed, 1 failed"
    exit 1
fi
echo "$passed passed, 0 failed"
