#!/usr/bin/env bash
# Exports the testbed as a game, in both kinds, runs each headless for a few seconds and checks what it says: the loop ran at its rate
# with a hand that felt something, without a fault; the native library lies beside the game; nothing of the editor or the tests is in.
#   export_test.sh [debug] [release]     default both
# The private Godot's templates are fetched once (about 180 MB); a Godot of yours needs those that its editor installs.
# Last line "N passed, N failed"; exit code 1 when a kind failed. The games stay in build/export/.
# A Godot of yours that has no templates for the version: the log of the export says where it looks for them.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
kinds=("$@")
[[ $# -gt 0 ]] || kinds=(debug release)
export GODOT_HAPTICS_ISOLATED=1

templates=$("$root/tools/setup/provide" godot-templates) || exit 1
"$root/tools/run/build" release --target haptics_publish >/dev/null || exit 1

# a project of its own: the addon and the scenes, and the probe as an autoload
work=$root/build/export
project=$work/project
rm -rf "$work"
mkdir -p "$project/addons" "$project/.godot"
touch "$root/build/.gdignore"
ln -s "$root/addons/haptics" "$project/addons/haptics"
ln -s "$root/scenes" "$project/scenes"
cp "$root/tools/testing/export_probe.gd" "$project/"
{
    cat "$root/project.godot"
    printf '\n[autoload]\n\nExportProbe="*res://export_probe.gd"\n'
} >"$project/project.godot"
echo 'res://addons/haptics/haptics.gdextension' >"$project/.godot/extension_list.cfg"
cat >"$project/export_presets.cfg" <<END
[preset.0]
name="Linux"
platform="Linux"
runnable=true
export_filter="all_resources"
include_filter=""
exclude_filter="addons/haptics/editor/*"
script_export_mode=2

[preset.0.options]
custom_template/debug="${templates:+$templates/godot-template-debug}"
custom_template/release="${templates:+$templates/godot-template-release}"
debug/export_console_wrapper=0
binary_format/embed_pck=false
texture_format/s3tc_bptc=true
texture_format/etc2_astc=false
binary_format/architecture="x86_64"
END

# check_game FOLDER LOG: what is wrong with the game and what it said, a line each
check_game() {
    local game=$1 log=$2
    [[ -s $game/libhaptics.linux.x86_64.so ]] || echo "the native library does not lie beside the game"
    cmp -s "$game/libhaptics.linux.x86_64.so" "$root/addons/haptics/bin/libhaptics.linux.x86_64.so" ||
        echo "the library beside the game is not the one of the project"
    # Debian's templates say this of every Control in a container that is freed, in a project without us too
    grep -aE 'ERROR|WARNING|leaked|handle_crash' "$log" | grep -avE "disconnect a nonexistent connection .*'(size_flags|visibility)_changed', callable: ''"
    grep -a '^packed: .*\(/editor/\|/tests/\|/gut\)' "$log"
    grep -qa '^packed: res://scenes/01_testbed/testbed' "$log" || echo "the game did not tell what is in it"
    python3 - "$game/run.json" 2>&1 <<'END'
import json, sys
figures = json.load(open(sys.argv[1], encoding="utf-8"))
def want(what, holds):
    if not holds: print(what, {k: figures.get(k) for k in ("steps", "ve_ticks", "max_force_n", "faults", "mode")})
want("no loop in real time", figures.get("mode") == "realtime")
want("too few haptic steps", figures.get("steps", 0) > 0.3 * 3.0 * figures.get("haptic_rate_hz", 1e9))
want("too few ticks", figures.get("ve_ticks", 0) > 30)
want("nothing was felt", 0.2 < figures.get("max_force_n", 0.0) < 30.0)
want("a fault", figures.get("faults") == [])
END
}

passed=0 failed=0
for kind in "${kinds[@]}"; do
    game=$work/$kind log=$work/$kind.log code=0
    mkdir -p "$game"
    timeout 300 "$root/tools/godot" --headless --path "$project" "--export-$kind" Linux "$game/testbed.x86_64" >"$work/$kind.export.log" 2>&1 </dev/null
    if [[ ! -x $game/testbed.x86_64 ]]; then
        tail -n 20 "$work/$kind.export.log"
        failed=$((failed + 1))
        continue
    fi
    (cd "$game" && timeout --kill-after=5 60 ./testbed.x86_64 --headless) >"$log" 2>&1 </dev/null || code=$?
    wrong=$(check_game "$game" "$log"
        [[ $code -eq 0 ]] || echo "the game ended with code $code"
        grep -qa "^build: $kind$" "$log" || echo "it is no $kind build")
    if [[ -n $wrong ]]; then
        printf '%s: %s\n' "$kind" "$wrong"
        tail -n 20 "$log"
        failed=$((failed + 1))
    else
        sed -n '/^Haptic run/,/faults/p' "$log"
        passed=$((passed + 1))
    fi
done
echo "$passed passed, $failed failed"
[[ $failed -eq 0 && $passed -gt 0 ]]
