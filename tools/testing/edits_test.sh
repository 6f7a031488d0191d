#!/usr/bin/env bash
# Random changes of a scene while its tool touches it (tests/integration/test_scene_life.gd), in lock-step and in real time, with the
# native library under AddressSanitizer: 10,000 edits, where the suites make a few hundred without it.
#   edits_test.sh [EDITS] [SEED]     default 10000 1
# Last line "N passed, N failed"; the exit code is not 0 when a test failed or the sanitizer found something.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# the engine itself is not instrumented: what it leaves behind is not ours
export HAPTICS_EDITS=${1:-10000} HAPTICS_SEED=${2:-1}

build=$root/build/asan_game
mkdir -p "$build"
exec 7>"$build.lock"
flock 7
{
    [[ -f $build/build.ninja ]] ||
        cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DHAPTICS_SANITIZE=address \
            -DHAPTICS_TESTS=OFF -DHAPTICS_PUBLISH=OFF 7>&-
    cmake --build "$build" --target haptics 7>&-
} >"$build.log" 2>&1 || { tail -n 30 "$build.log" >&2 && exit 1; }
library=$(find "$build" -name 'libhaptics.linux.x86_64.so' -print -quit)

# the runner starts the engine through this, and nothing else under the sanitizer
engine=$("$root/tools/godot" --where | sed -n 1p)
"${CC:-cc}" -shared -fPIC -o "$build/no_deepbind.so" "$root/tools/testing/no_deepbind.c"
report=$build/report
rm -f "$report".*
cat >"$build/godot" <<END
#!/bin/sh
export ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0:log_path=$report:exitcode=99
LD_PRELOAD="$build/no_deepbind.so $("${CXX:-c++}" -print-file-name=libasan.so)" exec "$engine" "\$@"
END
chmod +x "$build/godot"
status=0
export GUT_RUNNER_TEST_SECONDS=$((120 + HAPTICS_EDITS / 10))
GODOT=$build/godot GODOT_HAPTICS_ISOLATED=1 HAPTICS_LIBRARY=$library "$root/tools/gut_runner/run.sh" \
    --filter=test_random_edits --timeout=$((2 * GUT_RUNNER_TEST_SECONDS)) || status=$?
for found in "$report".*; do
    [[ -e $found ]] || continue
    cat "$found"
    status=1
done
exit "$status"
