#!/usr/bin/env bash
# Prints where hidapi's hidraw library is: the system's, else the private copy that the build took the header from.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
name=libhidapi-hidraw.so.0
library=$(ldconfig -p 2>/dev/null | awk -v name="$name" '$1 == name { print $NF; exit }' || true)
[[ -n $library ]] || library=$(find "$("$root/tools/setup/provide" hidapi)/usr/lib" -name "$name" | head -n 1)
[[ -n $library ]] || { echo "there is no $name; install libhidapi-hidraw0" >&2 && exit 1; }
printf '%s\n' "$library"
