# shellcheck shell=bash
# Sourced after lib.sh and apt.sh: an X server without a screen, a window manager for it, and xdotool.

display_key() { printf '%s, %s' "$DISPLAY_PACKAGES" "$(. /etc/os-release 2>/dev/null && printf '%s' "${VERSION_CODENAME:-}")"; }

# sets display_prefix to "" when the system has it all, else to the private folder
resolve_display() {
    display_prefix=
    if command -v Xvfb >/dev/null && command -v xkbcomp >/dev/null && command -v openbox >/dev/null; then return; fi
    install_once display "$(display_key)" build_display
    display_prefix=$cache_dir/display
}

build_display() {
    apt_require "Xvfb" "Install Xvfb, xkbcomp and openbox, or run with a display."
    # shellcheck disable=SC2086
    apt_unpack "$1" own $DISPLAY_PACKAGES || die "could not fetch $DISPLAY_PACKAGES (see the messages of apt above)"
    # what the system has already was not fetched
    [[ ! -f $1/usr/bin/Xvfb ]] || patch_xvfb "$1/usr/bin/Xvfb"
}

# Xvfb starts /usr/bin/xkbcomp and has no option for another place. With that folder's name emptied it starts
# the xkbcomp on PATH: the string's first byte becomes its end.
patch_xvfb() {
    python3 - "$1" <<'EOF'
import sys

path = sys.argv[1]
with open(path, "rb") as file:
    program = file.read()
if program.count(b"\0/usr/bin\0") != 1:
    sys.exit(f"[set-up] error: {path} does not name /usr/bin once, as Xvfb did; install Xvfb on the system")
with open(path, "wb") as file:
    file.write(program.replace(b"\0/usr/bin\0", b"\0\0usr/bin\0"))
EOF
}
