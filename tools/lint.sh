#!/bin/bash
# clang-tidy with the checks of .clang-tidy over the rooms without libtorch (with it, a unit
# takes half a minute): all of their files, or those that changed since a commit.
#   tools/lint.sh [COMMIT]
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=$(tools/draw_rooms.sh --rooms)
rooms=${rooms%% nn *}
if [ -n "${1:-}" ]; then
  files=$(git diff --name-only --diff-filter=d "$1" | grep -E "^(${rooms// /|})/[^/]*\.cpp$" || true)
else
  files=$(for room in $rooms; do ls "$room"/*.cpp; done)
fi
[ -n "$files" ] || { echo "no files to check"; exit 0; }
# Compile commands of the build name unity units, not these files; one set of flags fits all
# rooms without libtorch.
root=$(pwd)
flags="-std=c++20 -I$root -I$root/include $(pkg-config --cflags-only-I eigen3 cairo libxxhash libarchive | sed 's/-I/-isystem /g')"
# shellcheck disable=SC2086
printf '%s\n' $files | xargs -n 4 -P "${JOBS:-$(nproc)}" sh -c '
  flags=$1; shift
  clang-tidy-14 --quiet --warnings-as-errors="*" "$@" -- $flags 2>/dev/null' - "$flags" ||
  { echo "clang-tidy found something to mend" >&2; exit 1; }
echo "clang-tidy: $(wc -w <<<"$files") files are clean"
