#!/usr/bin/env bash
# Tests the runner itself: every folder of self_test/ holds suites and, in expect.sh, what a run of them must say.
#   self_test.sh [--gut] [CASE…]     --gut: the same through GUT itself, for the cases that hold there too
# A suite that must not parse is kept as .gd.txt. Prints, as last line, "N passed, N failed".
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
root=$(cd "$here/../.." && pwd -P)
kind=ours cases=()
for argument in "$@"; do
    if [[ $argument == --gut ]]; then kind=gut; else cases+=("$argument"); fi
done
[[ ${#cases[@]} -gt 0 ]] || mapfile -t cases < <(cd "$here/self_test" && printf '%s\n' */ | tr -d /)

# run_case NAME: prints what does not hold, and nothing when all does
run_case() (
    arguments=() mentions=() gut=''
    source "$here/self_test/$1/expect.sh"
    if [[ $kind == gut ]]; then
        [[ $gut == same ]] || { echo skipped && return; }
        last=${gut_last:-$last}
        [[ -z ${gut_mentions:-} ]] || mentions=("${gut_mentions[@]}")
        arguments+=(--gut)
    fi
    tests=$root/build/self_test/$1
    rm -rf "$tests" && mkdir -p "$root/build/self_test" && cp -r "$here/self_test/$1" "$tests" && rm "$tests/expect.sh"
    find "$tests" -name '*.gd.txt' | while IFS= read -r file; do mv "$file" "${file%.txt}"; done
    output=$("$here/run.sh" "--tests=$tests" "${arguments[@]}" "${imported[@]}" 2>&1)
    code=$?
    [[ $code == "$exit_code" ]] || echo "exit code $code, expected $exit_code"
    tail -n 1 <<<"$output" | grep -qE -- "$last" || echo "last line '$(tail -n 1 <<<"$output")', expected $last"
    for text in "${mentions[@]}"; do
        grep -qE -- "$text" <<<"$output" || echo "nothing printed like: $text"
    done
    printf '%s\n' "$output" >"$tests.$kind.log"
)

passed=0 failed=0 imported=()
for name in "${cases[@]}"; do
    complaints=$(run_case "$name")
    imported=(--imported) # the runner's classes are known now, and no case names one of its own
    if [[ $complaints == skipped ]]; then
        echo "skipped $name: not the same through GUT"
    elif [[ -z $complaints ]]; then
        passed=$((passed + 1))
        echo "ok      $name"
    else
        failed=$((failed + 1))
        printf 'FAILED  %s (%s)\n%s\n' "$name" "build/self_test/$name.$kind.log" "$(sed 's/^/        /' <<<"$complaints")"
    fi
done
echo "runner: $kind"
echo "$passed passed, $failed failed"
[[ $failed == 0 && $passed -gt 0 ]]
