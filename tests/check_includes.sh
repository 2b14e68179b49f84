#!/bin/sh
# Checks that #include goes only downward: a room may use the rooms above it in the list of
# CMakeLists.txt, never those below; that the rooms before nn and the public headers stay free
# of libtorch; and that public headers include nothing but each other. tools/draw_rooms.sh
# reads the same includes.
set -eu
cd "${1:-$(dirname "$0")/..}"
rooms="$(tools/draw_rooms.sh --rooms) tools"
for room in $rooms include/remomask; do
  find "$room" \( -name '*.h' -o -name '*.cpp' -o -name '*.in' \) -exec \
    grep -HnE '^[[:space:]]*#include[[:space:]]+["<][A-Za-z0-9_.-]+/' {} + || true
done | awk -v rooms="$rooms" '
  BEGIN {
    count = split(rooms, name, " ")
    for (i = 1; i <= count; ++i) level[name[i]] = i
    public_level = 0
  }
  {
    split($0, place, ":"); file = place[1]
    from = file; sub(/\/.*/, "", from)
    where = file ":" place[2] ": "
    match($0, /#include[ \t]+["<]/)
    target = substr($0, RSTART + RLENGTH); sub(/[">].*/, "", target)
    to = target; sub(/\/.*/, "", to)
    quoted = $0 ~ /#include[ \t]+"/
    seen++
    if (from == "include") {
      if (to != "remomask") { print where "a public header must not include " target; bad++ }
    } else if (to == "remomask") {
      # Public headers are below every room.
    } else if (to in level) {
      if (level[to] > level[from]) { print where from " must not use " to; bad++ }
    } else if (quoted) {
      print where "there is no room " to; bad++
    }
    if (to ~ /^(torch|ATen|c10)$/ && (from == "include" || level[from] < level["nn"])) {
      print where from " must not use libtorch"; bad++
    }
  }
  END {
    if (bad) { print bad " includes are not allowed"; exit 1 }
    if (!seen) { print "no includes found: wrong folder?"; exit 1 }
    print "all " seen " includes go downward"
  }'
