#!/bin/sh
# Draws docs/generated.png, the picture of the README, with the shipped model: motions of
# prompts that are no captions of the training data, under each the retrieved clip that it
# began as.
#   tools/readme_picture.sh [OUTPUT.png]
set -eu
cd "$(dirname "$0")/.."
output=${1:-docs/generated.png}
remomask=${REMOMASK:-build/release/tools/remomask}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
set --
number=0
for prompt in "someone walks forward, then stops" "a person sits on a chair and stands up again" \
  "a person waves the left hand"; do
  number=$((number + 1))
  motion="$folder/$number.bvh"
  "$remomask" --quiet generate "$prompt" --seconds 4.4 --seed 3 -o "$motion" >/dev/null
  clip=$(sed -n 's/.*"followed": "{\\"clip\\":\\"\([^\\]*\)\\".*/\1/p' "$motion.json")
  "$remomask" --quiet db export models/procedural.sqlite "$folder/clip$number" "$clip" >/dev/null
  mv "$folder/clip$number/$clip.npy" "$folder/began as $clip.npy"  # the title of its row
  set -- "$@" "$motion" "$folder/began as $clip.npy"
done
"$remomask" --quiet sheet "$@" -o "$output" >/dev/null
