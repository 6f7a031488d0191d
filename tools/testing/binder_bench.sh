#!/usr/bin/env bash
# Prints what a call from a script into the binder costs, by kind of argument.
#   binder_bench.sh [LIBRARY]     as binder_test.sh
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# shellcheck source=stage_probe.sh
source "$root/tools/testing/stage_probe.sh"

mkdir -p "$root/build"
library=${1:-$(probe_library "$root/build/binder_probe")}
project=$(mktemp -d)
trap 'rm -rf "$project"' EXIT
stage_probe "$project" "$library"
timeout 120 "$root/tools/godot" --headless --path "$project" -s res://bench_calls.gd 2>&1 |
    grep -aE '^ +-?[0-9.]+ ns|ERROR|Error' || { echo "binder_bench.sh: nothing was measured" >&2 && exit 1; }
