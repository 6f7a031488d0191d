# shellcheck shell=bash
# Sourced after lib.sh and apt.sh: C++ libraries and the second compiler, from packages of the machine's own release.

release_name() { . /etc/os-release 2>/dev/null && printf '%s' "${ID:-}-${VERSION_ID:-}"; }

# install_packages NAME HELP PACKAGES...: a private copy of packages in $cache_dir/NAME
install_packages() {
    local name=$1
    packages_help=$2
    shift 2
    wanted_packages=("$@")
    install_once "$name" "$* on $(release_name)" build_packages
}

build_packages() {
    apt_require "${wanted_packages[*]}" "$packages_help"
    apt_unpack "$1" own "${wanted_packages[@]}" ||
        die "could not fetch ${wanted_packages[*]} (see the messages of apt above). $packages_help"
    [[ -s $1/packages.txt ]] || die "${wanted_packages[*]}: installed here by apt already, but too old or broken. $packages_help"
}

# compiles FILE: a C++20 compiler that also links against this system's standard library, and has its address checks
compiles() {
    local scratch status=0
    scratch=$(mktemp -d)
    printf '#include <iostream>\n#include <span>\nint main() { std::cout << std::span<int>{}.size(); }\n' >"$scratch/a.cpp"
    "$1" -std=c++20 -fsanitize=address,undefined "$scratch/a.cpp" -o "$scratch/a" >"$scratch/log" 2>&1 &&
        "$scratch/a" >/dev/null || status=1
    rm -rf "$scratch"
    return "$status"
}

# sets clang_path
resolve_clang() {
    local name version
    for name in clang++ clang++-{22,21,20,19,18,17,16,15,14}; do
        clang_path=$(command -v "$name") || continue
        version=$("$clang_path" --version 2>/dev/null | grep -oE 'version [0-9.]+' | head -n 1 | cut -d' ' -f2)
        if [[ -n $version ]] && version_at_least "$version" "$CLANG_MINIMUM" && compiles "$clang_path"; then return; fi
    done
    install_once clang "$CLANG_PACKAGES on $(release_name) at $cache_dir/clang" build_clang
    clang_path=$cache_dir/clang/clang++
}

build_clang() {
    local partial=$1 final=$2 package folder help="Install clang $CLANG_MINIMUM or newer."
    apt_require "clang" "$help"
    for package in $CLANG_PACKAGES; do
        # shellcheck disable=SC2086
        apt_unpack "$partial" own ${package//+/ } && break
        find "$partial" -mindepth 1 -delete
    done
    folder=$(find "$partial/usr/lib" -path '*/llvm-*/bin/clang++' -printf '%h\n' 2>/dev/null | head -n 1)
    [[ -n $folder ]] || die "could not fetch any of $CLANG_PACKAGES (see the messages of apt above). $help"
    # starts the compiler with its own libraries; it finds the system's headers and standard library by itself
    printf '#!/bin/sh\nLD_LIBRARY_PATH="%s${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "%s" "$@"\n' \
        "$final/usr/lib/x86_64-linux-gnu" "$final/${folder#"$partial"/}/clang++" >"$partial/clang++"
    chmod +x "$partial/clang++"
    sed "s|$final|$partial|g" "$partial/clang++" >"$partial/clang++.try"
    chmod +x "$partial/clang++.try"
    compiles "$partial/clang++.try" || die "the fetched clang cannot compile against this system's C++ library. $help"
    rm "$partial/clang++.try"
}
