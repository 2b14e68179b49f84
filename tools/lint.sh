#!/bin/bash
# clang-tidy with the checks of .clang-tidy over the rooms without libtorch (with it, a unit
# takes half a minute): all of them, or those with files that changed since a commit. A room is
# read as one unit, as it is compiled: nearly all of the time goes into the headers.
#   tools/lint.sh [COMMIT]
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=$(tools/draw_rooms.sh --rooms)
rooms=${rooms%% nn *}
if [ -n "${1:-}" ]; then
  changed=$(git diff --name-only --diff-filter=d "$1" | sed -nE 's:^([a-z]+)/[^/]*\.(h|cpp)$:\1:p' | sort -u)
  rooms=$(for room in $rooms; do grep -qx "$room" <<<"$changed" && echo "$room"; done || true)
fi
[ -n "$rooms" ] || { echo "no rooms to check"; exit 0; }
units=$(mktemp -d)
trap 'rm -rf "$units"' EXIT
for room in $rooms; do
  for file in "$room"/*.cpp; do echo "#include \"$file\""; done >"$units/$room.cpp"
done
# Compile commands of the build name its own unity units; one set of flags fits all rooms
# without libtorch.
root=$(pwd)
flags="-std=c++20 -I$root -I$root/include $(pkg-config --cflags-only-I eigen3 cairo libxxhash libarchive | sed 's/-I/-isystem /g')"
# shellcheck disable=SC2086
printf '%s\n' $rooms | xargs -n 1 -P "${JOBS:-$(nproc)}" sh -c '
  clang-tidy-14 --quiet --config-file="$3/.clang-tidy" \
    --checks=-bugprone-suspicious-include --header-filter="$3/(include/remomask|$4)/.*" \
    "$2/$4.cpp" -- $1 2>/dev/null' - "$flags" "$units" "$root" ||
  { echo "clang-tidy found something to mend" >&2; exit 1; }
echo "clang-tidy: $(wc -w <<<"$rooms") rooms are clean"
