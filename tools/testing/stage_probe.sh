# shellcheck shell=bash
# stage_probe FOLDER LIBRARY: a project in FOLDER that loads the binder's test library. Sourced by the tests beside it.
stage_probe() {
    local folder=$1 library=$2
    mkdir -p "$folder/.godot"
    cp "$root"/native/tests/binder/project/* "$folder/"
    install_library "$library" "$folder"
    # without this list scripts do not see the extension before a first import
    echo "res://binder_probe.gdextension" >"$folder/.godot/extension_list.cfg"
}

# install_library LIBRARY FOLDER: under a temporary name and renamed, as a running engine has the old file mapped.
install_library() {
    local name=libbinder_probe.linux.x86_64.so
    cp "$1" "$2/$name.new"
    mv "$2/$name.new" "$2/$name"
}

# probe_library BUILD: builds the test library in a build folder of its own and prints where it is.
probe_library() {
    local build=$1
    {
        [[ -e $build/CMakeCache.txt ]] ||
            cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DHAPTICS_PUBLISH=OFF
        cmake --build "$build" --target haptics_binder_probe
    } >"$build.log" 2>&1 || {
        tail -n 30 "$build.log" >&2
        return 1
    }
    echo "$build/native/tests/binder/libbinder_probe.linux.x86_64.so"
}
