#!/bin/bash
# Draws which room includes which, from the #include lines, into docs/architecture.md
# (between its two marks), and checks the bounds of the plan: no arrow upward, fewer than
# 60 % of the possible arrows, no room with 13 % or more of the lines of code.
#   tools/draw_rooms.sh            writes the drawing
#   tools/draw_rooms.sh --check    fails if the drawing is not up to date or a bound is broken
#   tools/draw_rooms.sh --rooms    prints the rooms, lowest first
set -euo pipefail
cd "$(dirname "$0")/.."
document=docs/architecture.md
max_arrows=60  # percent of the possible ones
max_room=13    # percent of the lines

rooms=$(awk '/^set\(REMOMASK_ROOMS/ { on = 1; sub(/.*REMOMASK_ROOMS/, "") }
             on { last = /\)/; sub(/\).*/, ""); print; if (last) exit }' CMakeLists.txt | xargs)
[ "${1:-}" != --rooms ] || { echo "$rooms"; exit; }
rooms="$rooms tools"

# A public header belongs to the room that implements it. Headers of plain values belong to the
# lowest room that they can stand in, since the rooms between use them as well.
home_of() {
  case $1 in
    motion | skeleton | clip | search | generation) echo motion ;;
    motion_file | rotations) echo rig ;;
    text_to_motion) echo pipeline ;;
    training | remomask) echo training ;;  # remomask.h includes them all
    *) echo base ;;
  esac
}
homes=""
for header in include/remomask/*.h; do
  name=$(basename "$header" .h)
  homes="$homes $name=$(home_of "$name")"
done

# Files of each room, with the public headers: "room file" a line.
files=$(
  for room in $rooms; do
    find "$room" \( -name '*.h' -o -name '*.cpp' -o -name '*.in' \) -printf "$room %p\n"
  done
  for home in $homes; do echo "${home#*=} include/remomask/${home%=*}.h"; done
)
lines=$(while read -r room file; do echo "$room $(wc -l <"$file")"; done <<<"$files" |
  awk '{ sum[$1] += $2 } END { for (room in sum) print room, sum[room] }')
# "room used" a line.
includes=$(while read -r room file; do
  sed -nE "s|^[[:space:]]*#include[[:space:]]+\"([a-z_]+)/([a-z_]+)\..*|$room \1 \2|p" "$file"
done <<<"$files" | awk -v homes="$homes" '
  BEGIN { count = split(homes, home, " "); for (i in home) { split(home[i], part, "="); of[part[1]] = part[2] } }
  { print $1, $2 == "remomask" ? of[$3] : $2 }' | sort -u)

drawing=$(awk -v rooms="$rooms" -v lines="$lines" -v max_arrows=$max_arrows -v max_room=$max_room '
  $1 != $2 { arrow[$1, $2] = 1 }
  END {
    count = split(rooms, name, " ")
    rows = split(lines, row, "\n")
    for (i = 1; i <= rows; ++i) { split(row[i], part, " "); size[part[1]] = part[2]; all += part[2] }
    for (i = 1; i <= count; ++i) {
      for (j = 1; j <= count; ++j) {
        if (!((name[i], name[j]) in arrow)) continue
        ++arrows
        if (j > i) { print "upward: " name[i] " uses " name[j] > "/dev/stderr"; bad = 1 }
      }
      if (size[name[i]] > size[largest]) largest = name[i]
    }
    possible = count * (count - 1) / 2
    percent = 100 * arrows / possible
    share = 100 * size[largest] / all
    if (percent >= max_arrows) { printf "%d of %d possible arrows: %d %% or more\n", arrows, possible, max_arrows > "/dev/stderr"; bad = 1 }
    if (share >= max_room) { printf "room %s has %.1f %% of the lines: %d %% or more\n", largest, share, max_room > "/dev/stderr"; bad = 1 }
    if (bad) exit 1
    print "A mark says that the room of the row includes headers of the room of the column."
    print ""
    line = "| room |"; rule = "|---|"
    for (j = 1; j < count; ++j) { line = line " " j " |"; rule = rule ":-:|" }
    print line; print rule
    for (i = 1; i <= count; ++i) {
      line = "| " i " `" name[i] "` |"
      for (j = 1; j < count; ++j) line = line (((name[i], name[j]) in arrow) ? " ● |" : "   |")
      print line
    }
    print ""
    printf "%d of %d possible arrows (%.0f %%), none upward.\n", arrows, possible, percent
    # Not part of the drawing, which would be out of date with every edit.
    printf "largest room: %s, %.1f %% of %d lines\n", largest, share, all > "/dev/stderr"
  }' <<<"$includes")

begin='<!-- drawing by tools/draw_rooms.sh -->'
end='<!-- end of the drawing -->'
new=$(mktemp)
trap 'rm -f "$new"' EXIT
awk -v begin="$begin" -v end="$end" -v drawing="${drawing//\\/\\\\}" '
  $0 == begin { print; print ""; print drawing; print ""; skip = 1 }
  $0 == end { skip = 0 }
  !skip && $0 != begin' "$document" >"$new"
if [ "${1:-}" = --check ]; then
  diff -u "$document" "$new" ||
    { echo "$document is not up to date: run tools/draw_rooms.sh" >&2; exit 1; }
  echo "the drawing of the rooms is up to date"
else
  cat "$new" >"$document"
fi
