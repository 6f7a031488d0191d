#!/usr/bin/env bash
# Makes a project that sees our files through links and holds exactly one GutTest: our runner, or GUT itself.
#   stage.sh ours|gut [FOLDER]    with FOLDER: nothing of ours but the settings, and that folder as tests/ (self_test.sh)
# GUT is taken from addons/gut, or from $GUT_FOLDER to try another copy of it.
# HAPTICS_LIBRARY names another native library to load, one with checks built in.
# Prints the project's folder, build/staging/<kind>, build/staging/self_test_<kind> or, with another library, <kind>_checked.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
root=$(cd "$here/../.." && pwd -P)
kind=${1:?ours or gut} tests=${2:-}
project=$root/build/staging/${tests:+self_test_}$kind${HAPTICS_LIBRARY:+_checked}

mkdir -p "$project/addons"
touch "$root/build/.gdignore"
find "$project" -mindepth 1 -maxdepth 1 -type l -delete
find "$project/addons" -mindepth 1 -maxdepth 1 -type l -delete
for folder in "$project"/addons/gut "$project"/addons/gut_host; do
    [[ ! -d $folder ]] || find "$folder" -type l -delete
done

if [[ -n $tests ]]; then
    # a copy, so that no .uid file lands beside the sources
    rm -rf "$project/tests" && cp -r "$tests" "$project/tests"
else
    # all that the project's own editor would see
    for entry in "$root"/*; do
        name=${entry##*/}
        case $name in addons | build | cmake | project.godot | *.md | LICENSE | Makefile | CMake* | *rc) continue ;; esac
        [[ -d $entry && -e $entry/.gdignore ]] || ln -s "$entry" "$project/$name"
    done
    # and the scripts behind the commands, which are tested too; copies, so that no .uid file lands beside them
    mkdir -p "$project/tools/run" && cp "$root"/tools/run/*.gd "$project/tools/run/"
    [[ -z ${HAPTICS_LIBRARY:-} ]] || rm -rf "$project/addons/haptics"
    for entry in "$root"/addons/*; do
        case ${entry##*/}:${HAPTICS_LIBRARY:-} in
            gut:*) ;;
            haptics:?*)
                mkdir -p "$project/addons/haptics/bin"
                find "$entry" -mindepth 1 -maxdepth 1 ! -name bin -exec ln -s -t "$project/addons/haptics" {} +
                ln -s "$HAPTICS_LIBRARY" "$project/addons/haptics/bin/libhaptics.linux.x86_64.so"
                ;;
            *) ln -s "$entry" "$project/addons/${entry##*/}" ;;
        esac
    done
fi

# what Godot left beside a script of ours that is gone
find "$project/addons" -mindepth 2 -name '*.uid' | while IFS= read -r uid; do
    [[ -e $here/addon/$(basename "$uid" .uid) || -e $here/editor_host/$(basename "$uid" .uid) ||
        -e $here/real_gut/$(basename "$uid" .uid) ]] || rm -f "$uid"
done

# the runner: one of the two. Folders of links, so that Godot's .uid files land here and not beside our sources.
link_files() {
    mkdir -p "$2"
    find "$1" -maxdepth 1 -type f ! -name '*.uid' -exec ln -s -t "$2" {} +
}
link_files "$here/editor_host" "$project/addons/gut_host"
if [[ $kind == gut ]]; then
    [[ -f ${GUT_FOLDER:-$root/addons/gut}/gut_cmdln.gd ]] || {
        echo "GUT is not in addons/gut: install it there from the editor's Asset Library (it is not committed)" >&2
        exit 2
    }
    rm -rf "$project/addons/gut"
    ln -s "${GUT_FOLDER:-$root/addons/gut}" "$project/addons/gut"
    link_files "$here/real_gut" "$project/addons/gut_host"
else
    link_files "$here/addon" "$project/addons/gut"
    ln -s "$here/known_noise.txt" "$project/addons/gut/known_noise.txt"
fi

python3 "$here/stage_settings.py" "$kind" "$root/project.godot" "$project/project.godot"
extension=$project/addons/haptics/haptics.gdextension
if [[ -e $extension ]]; then
    found=$(sed -n 's|.*= "res://\(.*\.so\)"$|\1|p' "$extension" | sort -u | while IFS= read -r file; do
        [[ ! -e $project/$file ]] || echo "$file"
    done)
    [[ -n $found ]] || { echo "the native library is not built: run make, then the suites" >&2 && exit 2; }
    # without this list the first import of an extension aborts at exit
    mkdir -p "$project/.godot"
    echo "res://addons/haptics/haptics.gdextension" >"$project/.godot/extension_list.cfg"
fi
echo "$project"
