#!/bin/sh
# Builds the program (and with "tests" as argument its tests) in build/release.
# A compiler process of a torch unit takes up to 1.5 GB: fewer jobs where memory is short.
set -eu
cd "$(dirname "$0")/.."
memory_gb=$(awk '/MemAvailable/ { print int($2 / 1048576) }' /proc/meminfo)
jobs=$(nproc)
most=$((memory_gb / 2))
[ "$most" -ge 1 ] || most=1
[ "$jobs" -le "$most" ] || jobs=$most
cmake --preset release >/dev/null
if [ "${1:-}" = tests ]; then
  cmake --build build/release -j "$jobs"
else
  cmake --build build/release -j "$jobs" --target remomask
fi
