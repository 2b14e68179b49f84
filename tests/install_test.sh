#!/bin/bash
# Installs BUILD_FOLDER into a temporary prefix, builds the examples against it by
# find_package(remomask), and runs them and the installed program with the installed
# models.
#   tests/install_test.sh BUILD_FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
unset REMOMASK_MODELS

cmake --install "$build" --prefix "$prefix" >/dev/null
# Nothing of the source tree may be needed.
cp -r "$root/examples" "$work/source"
launcher=$(command -v ccache || true)
cmake -S "$work/source" -B "$work/examples" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} >/dev/null
cmake --build "$work/examples" -j 2 >"$work/log" || { cat "$work/log"; exit 1; }
if grep -r "$root" "$prefix/lib/cmake" "$prefix/include"; then
  echo "the installed files name the source tree" >&2
  exit 1
fi

shipped=$prefix/share/remomask
"$work/examples/search_library_example" "$shipped/base.safetensors" "$shipped/procedural.sqlite" \
  "a person waves the right hand" | tee "$work/found"
grep -q '^1\. .*wav' "$work/found"
"$work/examples/generate_motion_example" "$shipped/base.safetensors" \
  "$shipped/procedural.sqlite" "a person waves the right hand" "$work/motion.bvh" | tee "$work/made"
grep -q '^from: .*wav' "$work/made"
grep -q '^Frames: 40' "$work/motion.bvh"

cd "$work"
"$prefix/bin/remomask" search "a person waves the right hand" -k 1 >"$work/found"
grep -q 'wav' "$work/found"
# It was the installed database, not that of the source tree.
echo damaged >"$shipped/procedural.sqlite"
if "$prefix/bin/remomask" search "a person waves the right hand" >"$work/found" 2>&1; then
  echo "the installed program reads other files than the installed ones" >&2
  exit 1
fi
grep -q "share/remomask/procedural.sqlite" "$work/found"
