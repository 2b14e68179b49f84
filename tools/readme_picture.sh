#!/bin/sh
# Draws docs/generated.png, the picture of the README, with the shipped model; none of the
# prompts is a caption of the training data.
#   tools/readme_picture.sh [OUTPUT.png]
set -eu
cd "$(dirname "$0")/.."
output=${1:-docs/generated.png}
remomask=${REMOMASK:-build/release/tools/remomask}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
number=0
for prompt in "someone walks forward, then stops" "someone raises both hands above the head" \
  "a person sits on a chair and stands up again" "a person waves the left hand"; do
  number=$((number + 1))
  "$remomask" --quiet generate "$prompt" --seconds 4.4 --seed 3 -o "$folder/$number.bvh" >/dev/null
done
"$remomask" --quiet sheet "$folder"/[1-4].bvh -o "$output" >/dev/null
