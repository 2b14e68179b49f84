#!/bin/sh
# Builds the program (and with "tests" as argument its tests) in build/release.
# A compiler process of a torch unit takes up to 1.5 GB: fewer jobs where memory is short.
#   tools/build.sh [tests] [CMAKE OPTION...]
set -eu
cd "$(dirname "$0")/.."
target="--target remomask"
if [ "${1:-}" = tests ]; then
  target=""
  shift
fi
memory_gb=$(awk '/MemAvailable/ { print int($2 / 1048576) }' /proc/meminfo)
jobs=${JOBS:-$(nproc)}
max_jobs=$((memory_gb / 2))
[ "$max_jobs" -ge 1 ] || max_jobs=1
[ "$jobs" -le "$max_jobs" ] || jobs=$max_jobs
cmake --preset release "$@" >/dev/null
# shellcheck disable=SC2086
cmake --build build/release -j "$jobs" $target
