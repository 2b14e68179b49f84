#!/bin/sh
# Checks that #include goes only downward: a room may use the rooms above it in
# this list (that of CMakeLists.txt), never those below, and the first three
# stay free of libtorch. Every file belongs to a room.
set -eu
cd "${1:-$(dirname "$0")/..}"
rooms="base motion db nn text retriever index generator evaluation tools"
for room in $rooms; do
  find "$room" \( -name '*.h' -o -name '*.cpp' -o -name '*.in' \) -exec \
    grep -HnE '^[[:space:]]*#include[[:space:]]+("[a-z_]+/|<(torch|ATen|c10)/)' {} + || true
done | awk -v rooms="$rooms" '
  BEGIN { count = split(rooms, name, " "); for (i = 1; i <= count; ++i) level[name[i]] = i }
  {
    split($0, place, ":"); split(place[1], path, "/"); from = path[1]
    where = place[1] ":" place[2] ": "
    if (match($0, /"[a-z_]+\//)) {
      to = substr($0, RSTART + 1, RLENGTH - 2)
      if (!(to in level) || level[to] > level[from]) { print where from " must not use " to; bad++ }
    } else if (level[from] <= level["db"]) { print where from " must not use libtorch"; bad++ }
    seen++
  }
  END {
    if (bad) { print bad " includes go upward"; exit 1 }
    if (!seen) { print "no includes found: wrong folder?"; exit 1 }
    print "all " seen " includes go downward"
  }'
