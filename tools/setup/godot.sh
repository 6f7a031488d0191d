# shellcheck shell=bash
# Sourced after lib.sh and apt.sh: which Godot runs, and the private copy of it.

# godot_version FILE: "4.6.3", or nothing when it is no Godot
godot_version() { "$1" --version 2>/dev/null | grep -oE '^[0-9]+\.[0-9]+(\.[0-9]+)?' | head -n 1 || true; }

# the place is in the key: the program carries the absolute path of its loader and libraries
godot_private_key() { printf '%s %s at %s' "$GODOT_MINIMUM" "$GODOT_PACKAGES" "$cache_dir/godot"; }

# sets godot_path and godot_kind (environment, path, private); installs the private copy when nothing else fits
resolve_godot() {
    local version
    if [[ -n ${GODOT:-} ]]; then
        godot_path=$(command -v "$GODOT") || die "\$GODOT is '$GODOT', which is no program; unset it or name a Godot $GODOT_MINIMUM or newer"
        version=$(godot_version "$godot_path")
        [[ -n $version ]] && version_at_least "$version" "$GODOT_MINIMUM" ||
            die "\$GODOT is '$GODOT', version '${version:-unknown}'; it has to be Godot $GODOT_MINIMUM or newer"
        godot_kind=environment
        return
    fi
    if godot_path=$(command -v godot); then
        version=$(godot_version "$godot_path")
        if [[ -n $version ]] && version_at_least "$version" "$GODOT_MINIMUM"; then
            godot_kind=path
            return
        fi
    fi
    install_once godot "$(godot_private_key)" build_private_godot
    godot_path=$cache_dir/godot/usr/bin/godot
    godot_kind=private
}

build_private_godot() {
    local partial=$1 final=$2 suite
    local help="Install Godot $GODOT_MINIMUM or newer and name it in \$GODOT, or put it on PATH as 'godot'."
    apt_require "Godot $GODOT_MINIMUM" "$help"
    [[ $(dpkg --print-architecture) == amd64 ]] || die "a private Godot can be made on x86-64 only. $help"
    [[ -n $(apt_debian_mirror) ]] || die "this machine's apt names no Debian mirror to fetch Godot $GODOT_MINIMUM from. $help"
    say "no Godot $GODOT_MINIMUM or newer here: making a private copy (about 160 MB to fetch, 650 MB on disk)"
    for suite in $GODOT_SUITES; do
        # shellcheck disable=SC2086
        if apt_unpack "$partial" "$suite" $GODOT_PACKAGES; then
            patch_programs "$partial" "$final" godot
            return
        fi
        find "$partial" -mindepth 1 -delete
    done
    die "could not fetch Godot from the suites $GODOT_SUITES (see the messages of apt above). $help"
}

# Sets templates_path to the folder with godot-template-debug and godot-template-release, of the private copy's version; empty when
# Godot is not the private copy, which has those that its own editor installed.
resolve_templates() {
    templates_path=''
    resolve_godot
    [[ $godot_kind == private ]] || return 0
    install_once godot-templates "$(godot_version "$godot_path") $TEMPLATE_PACKAGES at $cache_dir" build_private_templates
    templates_path=$cache_dir/godot-templates/usr/bin
}

build_private_templates() {
    local partial=$1 final=$2 suite version wanted
    wanted=$(godot_version "$cache_dir/godot/usr/bin/godot")
    say "fetching the export templates of Godot $wanted"
    for suite in $GODOT_SUITES; do
        # shellcheck disable=SC2086
        if apt_unpack "$partial" "$suite" $TEMPLATE_PACKAGES; then
            version=$(sed -n 's/^godot-template-debug_\([0-9.]*\).*/\1/p' "$partial/packages.txt")
            if [[ $version == "$wanted" ]]; then
                patch_programs "$partial" "$final" godot-template-debug godot-template-release
                return
            fi
            say "$suite has templates of version ${version:-unknown}"
        fi
        find "$partial" -mindepth 1 -delete
    done
    die "could not fetch the export templates of Godot $wanted: if there are newer ones, remove $cache_dir/godot, and the newer Godot is fetched"
}

# patch_programs PARTIAL FINAL PROGRAM...: makes them start by themselves with the loader and libraries of their own folder.
# Starting one through that loader would do too, but then the editor, which starts the game by the path of its own program, would
# start the loader.
patch_programs() {
    local partial=$1 final=$2 libraries=usr/lib/x86_64-linux-gnu file program version
    shift 2
    local loader=$libraries/ld-linux-x86-64.so.2
    [[ -x $partial/$loader ]] || die "the fetched C library has no $loader; Debian has moved it"
    local run=("$partial/$loader" --library-path "$partial/$libraries:$partial/$libraries/pulseaudio")
    local patchelf=("${run[@]}" "$partial/usr/bin/patchelf")
    for program in "$@"; do
        "${patchelf[@]}" --set-interpreter "$final/$loader" --force-rpath \
            --set-rpath "$final/$libraries:$final/$libraries/pulseaudio" "$partial/usr/bin/$program"
    done
    # a library with a run path of its own does not look into the program's
    while IFS= read -r file; do
        local path
        path=$("${patchelf[@]}" --print-rpath "$file" 2>/dev/null) && [[ -n $path ]] || continue
        "${patchelf[@]}" --set-rpath "${path//\/$libraries/$final/$libraries}:$final/$libraries" "$file"
    done < <(find "$partial/$libraries" -name '*.so*' -type f -not -path '*/gconv/*')
    for program in "$@"; do
        version=$(godot_version_through_loader "$partial/usr/bin/$program" "${run[@]}")
        [[ -n $version ]] && version_at_least "$version" "$GODOT_MINIMUM" ||
            die "the private $program says it is version '${version:-unknown}', wanted $GODOT_MINIMUM or newer"
        say "$program $version"
    done
}

godot_version_through_loader() {
    local program=$1
    shift
    "$@" "$program" --version 2>/dev/null | grep -oE '^[0-9]+\.[0-9]+(\.[0-9]+)?' | head -n 1 || true
}

# The private copy keeps its settings, caches and user:// in our cache. So does any Godot when GODOT_HAPTICS_ISOLATED is set,
# as tests do: they neither depend on a person's editor settings nor touch them.
prepare_home() {
    [[ $godot_kind == private || -n ${GODOT_HAPTICS_ISOLATED:-} ]] || return 0
    export XDG_DATA_HOME=$cache_dir/godot-home/data XDG_CONFIG_HOME=$cache_dir/godot-home/config
    export XDG_CACHE_HOME=$cache_dir/godot-home/cache
    # the place of our cache must not move for what Godot starts
    export GODOT_HAPTICS_CACHE=$cache_dir
    mkdir -p "$XDG_DATA_HOME" "$XDG_CONFIG_HOME" "$XDG_CACHE_HOME"
    # a machine without fonts has no configuration of them, which the engine would report as an error
    if [[ $godot_kind == private && ! -e /etc/fonts/fonts.conf ]]; then
        export FONTCONFIG_PATH=${FONTCONFIG_PATH:-$cache_dir/godot/etc/fonts}
    fi
}

has_gpu() { compgen -G '/dev/dri/renderD*' >/dev/null || [[ -e /dev/nvidia0 || -e /dev/dxg ]]; }

# The private copy brings its own drivers of Mesa, which have to be found; without a GPU they draw in software.
# Sets godot_arguments. An argument that the caller gives wins.
prepare_drawing() {
    godot_arguments=()
    [[ $godot_kind == private && -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} && " $* " != *" --headless "* ]] || return 0
    local prefix=$cache_dir/godot
    # data that the X libraries look for in the system's folders
    [[ -e /usr/share/X11/locale ]] || export XLOCALEDIR=${XLOCALEDIR:-$prefix/usr/share/X11/locale}
    [[ -e /usr/share/X11/xkb ]] || export XKB_CONFIG_ROOT=${XKB_CONFIG_ROOT:-$prefix/usr/share/X11/xkb}
    export LIBGL_DRIVERS_PATH=${LIBGL_DRIVERS_PATH:-$prefix/usr/lib/x86_64-linux-gnu/dri}
    export __EGL_VENDOR_LIBRARY_DIRS=${__EGL_VENDOR_LIBRARY_DIRS:-$prefix/usr/share/glvnd/egl_vendor.d:/usr/share/glvnd/egl_vendor.d:/etc/glvnd/egl_vendor.d}
    export GBM_BACKENDS_PATH=${GBM_BACKENDS_PATH:-$prefix/usr/lib/x86_64-linux-gnu/gbm}
    if ! has_gpu; then
        # through EGL: a screenless X server may lack what GLX needs
        export LIBGL_ALWAYS_SOFTWARE=${LIBGL_ALWAYS_SOFTWARE:-1}
        [[ " $* " == *" --rendering-driver "* ]] || godot_arguments+=(--rendering-driver opengl3_es)
    fi
    # no sound card and no sound server: the engine would report an error at every start
    if [[ " $* " != *" --audio-driver "* && ! -e /dev/snd/seq && -z ${PULSE_SERVER:-} && ! -e ${XDG_RUNTIME_DIR:-/none}/pulse ]]; then
        godot_arguments+=(--audio-driver Dummy)
    fi
}
