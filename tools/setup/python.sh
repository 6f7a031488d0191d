# shellcheck shell=bash
# Sourced after lib.sh, apt.sh and packages.sh: Python tools at exact versions, each group in a folder of its own.
# No virtual environment: a folder on PYTHONPATH needs neither the venv module nor an absolute path inside.

# the interpreter's kind is in the key: compiled modules fit one only
python_key() { printf '%s for %s' "$1" "$(python3 -c 'import sys, sysconfig; print(sys.implementation.cache_tag, sysconfig.get_platform())')"; }

# install_python GROUP REQUIREMENTS
install_python() {
    command -v python3 >/dev/null || die "python3 is missing; install Python $PYTHON_MINIMUM or newer"
    local version
    version=$(python3 -c 'import platform; print(platform.python_version())')
    version_at_least "$version" "$PYTHON_MINIMUM" || die "python3 is $version; install Python $PYTHON_MINIMUM or newer"
    python_requirements=$2
    install_once "python-$1" "$(python_key "$2")" build_python
}

build_python() {
    local pip=(python3 -m pip)
    if ! python3 -m pip --version >/dev/null 2>&1; then
        local wheel
        install_packages_here "$1/.pip" python3-pip-whl
        wheel=$({ find "$1/.pip" /usr/share/python-wheels -name 'pip-*.whl' 2>/dev/null || true; } | sort | tail -n 1)
        [[ -n $wheel ]] || die "python3 has no pip and none could be fetched; install pip"
        pip=(python3 "$wheel/pip")
    fi
    say "fetching $python_requirements"
    # shellcheck disable=SC2086
    PIP_USER=0 PIP_REQUIRE_VIRTUALENV=0 PIP_ROOT_USER_ACTION=ignore "${pip[@]}" install --quiet --disable-pip-version-check \
        --no-cache-dir --no-deps --only-binary ':all:' --target "$1" $python_requirements >&2 ||
        die "pip could not install $python_requirements; see its messages above"
    rm -rf "$1/.pip"
}

# a package next to what is being made, without the install_once that is already running
install_packages_here() {
    mkdir -p "$1"
    apt_require "pip" "Install pip for python3."
    apt_unpack "$1" own "$2" || die "could not fetch $2 (see the messages of apt above); install pip for python3"
}
