#!/usr/bin/env bash
# Runs the Godot suites of tests/ headless and prints, as last line, "N passed, N failed" (", N skipped" may follow).
#   run.sh [--gut] [--filter=TEXT] [--junit=FILE] [--timeout=SECONDS] [--imported]
#     --gut       through GUT itself, which has to be in addons/gut; else through the small runner in this folder
#     --filter    only tests whose full name, like tests/unit/test_x.gd:TestInner:test_name, contains TEXT
#     --junit     also writes the results as JUnit XML
#     --timeout   for each of the two processes (default 300): tests/unit and tests/integration run as a game,
#                 tests/editor inside of the editor
#     --imported  the same project was imported by a run before, and no class with a name is new
# It fails when a test failed or asserted nothing, when no test ran, when a suite does not parse or has no test, and
# when the engine reported an error that no test expected. Logs and results stay in build/test_reports/.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
root=$(cd "$here/../.." && pwd -P)

kind=ours filter='' junit='' limit=300 tests='' imported=no
for argument in "$@"; do
    case $argument in
        --gut) kind=gut ;;
        --filter=*) filter=${argument#*=} ;;
        --junit=*) junit=$(realpath -m "${argument#*=}") ;;
        --timeout=*) limit=${argument#*=} ;;
        --imported) imported=yes ;;
        --tests=*) tests=$(realpath "${argument#*=}") || exit 2 ;; # another folder, for the runner's own tests
        *) echo "run.sh: unknown argument '$argument'; known: --gut --filter= --junit= --timeout= --imported" >&2 && exit 2 ;;
    esac
done

godot=$(GODOT=${GODOT:-} "$root/tools/godot" --where | head -n 1)
[[ -x $godot ]] || { echo "run.sh: tools/godot found no Godot" >&2 && exit 2; }

mkdir -p "$root/build"
exec 8>"$root/build/.gut_runner_$kind.lock"
flock -n 8 || { echo "run.sh: waiting for another run of the suites"; flock 8; }

project=$("$here/stage.sh" "$kind" ${tests:+"$tests"}) || exit $?
reports=$root/build/test_reports/${project##*/}
rm -rf "$reports" && mkdir -p "$reports"
# what the engine and the tests write for themselves stays in the build folder
home=$root/build/staging/.home
mkdir -p "$home/data" "$home/config" "$home/cache"
export XDG_DATA_HOME=$home/data XDG_CONFIG_HOME=$home/config XDG_CACHE_HOME=$home/cache

# for suites that need the library itself, where the system has none
HAPTICS_TEST_HIDAPI=$("$root/tools/testing/hidapi_library.sh" 2>/dev/null || true)
export HAPTICS_TEST_HIDAPI

# show NAME: what a reader wants of a part's output; the editor's progress bars tell nothing
show() {
    if [[ $1 == import ]]; then
        cat >/dev/null
    else
        grep --line-buffered -avE '\[ *([0-9]+%|DONE) *\]|^.\[0m$|^Godot Engine' | cat -s
    fi
}

# part NAME COMMAND…: runs it with the time limit and keeps output, exit code and results apart for the report
part() {
    local name=$1 folder=$reports/$1
    shift
    mkdir -p "$folder"
    GUT_RUNNER_RESULTS=$folder/results.json GUT_RUNNER_FILTER=$filter \
        timeout --kill-after=10 "$limit" "$godot" --headless --path "$project" "$@" \
        2>"$folder/stderr.log" </dev/null 8>&- | tee "$folder/stdout.log" | show "$name"
    echo "${PIPESTATUS[0]}" >"$folder/exit_code"
}

# has_suites res://FOLDER…
has_suites() {
    [[ $# -gt 0 && -n $(find -L "${@/#res:\/\//$project/}" -name 'test_*.gd' -print -quit 2>/dev/null) ]]
}

dirs=()
for folder in unit integration; do [[ -d $project/tests/$folder ]] && dirs+=("res://tests/$folder"); done
if [[ $imported == no ]]; then part import --import; fi
if has_suites "${dirs[@]}"; then
    GUT_RUNNER_DIRS=$(IFS=, && echo "${dirs[*]}")
    export GUT_RUNNER_DIRS
    if [[ $kind == gut ]]; then
        hook=res://addons/gut_host/results_hook.gd
        part game -s res://addons/gut/gut_cmdln.gd "-gdir=$GUT_RUNNER_DIRS" -ginclude_subdirs -gexit -gconfig= \
            -gdisable_colors "-gpre_run_script=$hook" "-gpost_run_script=$hook"
    else
        part game -s res://addons/gut/main.gd
    fi
fi
if has_suites res://tests/editor; then
    GUT_RUNNER_IN_EDITOR=1 GUT_RUNNER_DIRS=res://tests/editor part editor --editor
fi

python3 "$here/report.py" --kind "$kind" --reports "$reports" --project "$project" \
    --noise "$here/known_noise.txt" --filter "$filter" ${junit:+--junit "$junit"}
