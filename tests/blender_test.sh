#!/bin/bash
# Blender places every joint of what the program writes where the program has it, also after it has
# written the file itself.
#   tests/blender_test.sh PROGRAM
# Exits with 77 (skipped) where Blender is not installed.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "$1")
command -v blender >/dev/null || { echo "skipped: Blender is not installed"; exit 77; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" --quiet procedural --db motions.sqlite --count 2 >/dev/null
formats="glb fbx"
# 3.4.1 of Debian 12 ends every import of BVH with an error of its own.
blender --version | grep -q "^Blender 3\.4" || formats="$formats bvh"
for format in npz $formats; do
  "$program" --quiet db export motions.sqlite $format --format $format >/dev/null
done
failed=0
for npz in npz/*.npz; do
  stem=$(basename "$npz" .npz)
  for format in $formats; do
    blender -b --python-exit-code 1 --python "$root/tests/readers/blender_joints.py" -- \
      "$format/$stem.$format" "$npz" >log 2>&1 || { failed=1; tail -20 log; }
    grep "frames in Blender" log || true
  done
done
exit $failed
