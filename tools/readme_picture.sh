#!/bin/sh
# Draws docs/generated.png, the picture of the README, with the shipped model: motions that no
# clip of the database shows. A walk whose arms alone were generated again, beside the walk that
# it was, and four sentences as one motion.
#   tools/readme_picture.sh [OUTPUT.png]
set -eu
cd "$(dirname "$0")/.."
output=${1:-docs/generated.png}
remomask="${REMOMASK:-build/release/tools/remomask} --quiet"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
$remomask generate "a person walks forward" --seconds 4.4 --seed 3 -o "$folder/walk.npy" >/dev/null
$remomask edit "$folder/walk.npy" --parts arms --prompt "someone raises both hands above the head" \
  --seed 2 --best-of 3 -o "$folder/arms.npy" >/dev/null
cat >"$folder/day.txt" <<END
3    a person walks forward
3    someone waves with the right hand
3    a person bows deeply
3    a person jumps up high twice
END
$remomask generate --script "$folder/day.txt" --seed 1 --best-of 2 -o "$folder/day.npy" >/dev/null
$remomask sheet "$folder/walk.npy" "$folder/arms.npy" "$folder/day.npy" --poses 11 \
  --title "a person walks forward" \
  --title "the same walk; arms alone: someone raises both hands above the head" \
  --title "walks forward; waves with the right hand; bows deeply; jumps up high twice" \
  --force -o "$output" >/dev/null
