# shellcheck shell=bash
# Sourced by the set-up scripts: where things go, messages, and "install once".

repo_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# shellcheck source=versions.env
source "$repo_root/tools/setup/versions.env"

cache_dir=${GODOT_HAPTICS_CACHE:-${XDG_CACHE_HOME:-${HOME:?HOME is not set: set GODOT_HAPTICS_CACHE}/.cache}/godot-haptics}
# an absolute path: installed programs carry it inside
[[ $cache_dir == /* ]] || cache_dir=$PWD/$cache_dir

say() { printf '[set-up] %s\n' "$*" >&2; }

die() {
    printf '[set-up] error: %s\n' "$*" >&2
    exit 1
}

# version_at_least HAVE WANT
version_at_least() { [[ $(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1) == "$2" ]]; }

# is_installed NAME KEY: the private copy NAME was made for exactly this key
is_installed() { [[ -f $cache_dir/$1/.done && $(<"$cache_dir/$1/.done") == "$2" ]]; }

# install_once NAME KEY BUILDER: runs `BUILDER TEMPORARY FINAL` once and renames its result to $cache_dir/NAME, so that an
# interrupted or failing set-up leaves nothing half made; a second process waits for the first.
install_once() {
    local name=$1 key=$2 builder=$3
    is_installed "$name" "$key" && return 0
    mkdir -p "$cache_dir" || die "cannot write to $cache_dir; set GODOT_HAPTICS_CACHE to a folder that you may write to"
    (
        flock -n 9 || { say "another set-up is running, waiting for it"; flock 9; }
        is_installed "$name" "$key" && exit 0
        local partial=$cache_dir/.partial-$name old=$cache_dir/.old-$name
        rm -rf "$partial" "$old"
        mkdir -p "$partial"
        # a new shell: `set -e` is off inside functions that are called in a condition
        "$builder" "$partial" "$cache_dir/$name" 9>&-
        printf '%s\n' "$key" >"$partial/.done"
        [[ ! -e $cache_dir/$name ]] || mv "$cache_dir/$name" "$old"
        mv "$partial" "$cache_dir/$name"
        rm -rf "$old"
        say "$name is ready in $cache_dir/$name"
    ) 9>"$cache_dir/.lock"
}
