#!/bin/bash
# Readers of other people place every joint of what the program writes where the program has it:
# three.js, bvhio and pybvh, and the validator of glTF. What is generated stands on the floor of a
# three.js page, in node and, where it is installed, in Chromium. blender_test.sh tries Blender.
#   tests/readers_test.sh PROGRAM CACHE_FOLDER
# The readers are installed into the cache folder ($REMOMASK_READERS, where that is set). Exits with
# 77 (skipped) and the reason where node or python3-venv is missing, or the network at first use.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "$1")
cache=${REMOMASK_READERS:-$2}
skip() { echo "skipped: $1"; exit 77; }
command -v node >/dev/null && command -v npm >/dev/null || skip "node and npm are not installed"
python3 -c 'import ensurepip' 2>/dev/null || skip "python3-venv is not installed"

mkdir -p "$cache"
cache=$(cd "$cache" && pwd)
pinned=$(cat "$root"/tests/readers/{requirements.txt,package.json} | sha256sum)
if [ "$(cat "$cache/pinned" 2>/dev/null)" != "$pinned" ]; then
  python3 -m venv "$cache/venv"
  "$cache/venv/bin/pip" -q install -r "$root/tests/readers/requirements.txt" || skip "no PyPI"
  cp "$root/tests/readers/package.json" "$cache"
  (cd "$cache" && npm install --silent --no-audit --no-fund) || skip "no npm registry"
  echo "$pinned" >"$cache/pinned"
fi
# node finds the packages above the folder of a script.
mkdir -p "$cache/scripts"
cp "$root"/tests/readers/*.mjs "$cache/scripts"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" --quiet procedural --db motions.sqlite --count 12 >/dev/null
for format in bvh npz glb vrma; do
  "$program" --quiet db export motions.sqlite $format --format $format >/dev/null
done
failed=0
try() { "$@" || failed=1; }
for bvh in bvh/*.bvh; do
  stem=$(basename "$bvh" .bvh)
  try "$cache/venv/bin/python" "$root/tests/readers/bvh_python.py" "$bvh" "npz/$stem.npz"
  try node "$cache/scripts/bvh_three.mjs" "$bvh" "npz/$stem.npz"
  for file in "glb/$stem.glb" "vrma/$stem.vrma"; do
    try node "$cache/scripts/gltf_three.mjs" "$file" "npz/$stem.npz"
  done
done
try node "$cache/scripts/gltf_validate.mjs" glb/*.glb vrma/*.vrma

number=0
for sentence in "a person walks forward and turns around" "a person sits down on a chair"; do
  number=$((number + 1))
  made="generated$number"
  for file in $made.npy $made.bvh $made.glb $made.vrma; do
    "$program" --quiet generate "$sentence" --seconds 4 --seed 1 -o "$file" >/dev/null
  done
  "$program" --quiet generate "$sentence" --seconds 4 --seed 1 -o "$made.m.bvh" --units m >/dev/null
  centimetres=("$made.npy" 0.01 "$made.bvh" "$made.glb" "$made.vrma")
  metres=("$made.npy" 1 "$made.m.bvh")
  try node "$cache/scripts/stands_node.mjs" "${centimetres[@]}"
  try node "$cache/scripts/stands_node.mjs" "${metres[@]}"
  if command -v chromium >/dev/null; then
    try node "$cache/scripts/stands_chromium.mjs" "${centimetres[@]}"
    try node "$cache/scripts/stands_chromium.mjs" "${metres[@]}"
  else
    echo "Chromium is not installed: not tried"
  fi
done
exit $failed
