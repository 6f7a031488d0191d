#!/usr/bin/env bash
# Runs the tests of the HID driver on the real hidapi, with devices emulated byte by byte behind it.
#   hid_test.sh [BUILD] [ARGUMENTS OF DOCTEST...]    BUILD: a finished build folder; build/release by default
# HAPTICS_HID_SECONDS=5 shortens the minute of the loop for a quick look.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
cd "$root"
build=build/release
if [[ $# -gt 0 && -d $1 ]]; then build=$1 && shift; fi
tests=$build/native/tests
preload=$(cd "$tests" && pwd -P)/haptics_hidraw_preload.so

library=$(tools/testing/hidapi_library.sh)
registry=$(mktemp -d)
trap 'rm -rf "$registry"' EXIT
# an address sanitizer wants to be first; the preload takes nothing of what it watches
export ASAN_OPTIONS=verify_asan_link_order=0${ASAN_OPTIONS:+:$ASAN_OPTIONS}
LD_PRELOAD=$preload HAPTICS_EMULATED_HID=$registry HAPTICS_HIDAPI=$library "$tests/haptics_hid_tests" "$@"
