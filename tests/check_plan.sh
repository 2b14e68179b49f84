#!/bin/sh
# Holds the plan of the code to what README.md says: the path to attention exists, evidence is made
# in one place, skeletons and presets are looked up by name in one place each, and the program of
# README.md is the sample that is built.
set -eu
cd "${1:-$(dirname "$0")/..}"
failed=0
fail() { echo "$1" >&2; failed=1; }

# sources: all code of the rooms and the public headers.
sources() {
  rooms=$(sed -n '/^set(REMOMASK_ROOMS/,/)/p' CMakeLists.txt | tr -d ')' | sed 's/set(REMOMASK_ROOMS//')
  # shellcheck disable=SC2086
  find $rooms tools include examples \( -name '*.cpp' -o -name '*.h' \)
}

path=$(sed -n '/<!-- path to attention -->/,/<!-- end of the path -->/s/^[0-9]*\. `\(.*\)`$/\1/p' README.md)
steps=$(echo "$path" | wc -l)
[ "$steps" -ge 2 ] && [ "$steps" -le 8 ] || fail "the path to attention has $steps files; 2 to 8 are allowed"
for file in $path; do
  [ -f "$file" ] || fail "the path to attention names $file, which does not exist"
done
# Each file leads to the next: it includes its header.
previous=""
for file in $path; do
  case $file in README.md) continue ;; esac
  header=${file%.cpp}.h
  if [ -n "$previous" ] && ! grep -q "#include \"$header\"" "$previous" "${previous%.cpp}.h" 2>/dev/null; then
    fail "$previous does not include $header, the next step of the path to attention"
  fi
  previous=$file
done
grep -q '_mm\|fma\|\*' "$previous" || fail "$previous does not multiply"

only_in() { # what, pattern, file
  found=$(sources | xargs grep -lE "$2" | sort | tr '\n' ' ')
  [ "$found" = "$3 " ] || fail "$1 must be in $3 alone, but is in: $found"
}
only_in "making evidence (RetrievedMotion for the generator)" 'RetrievedMotion [a-z_]+;' pipeline/evidence.cpp
only_in "the lookup of skeletons by name" 'name == "(kit|humanml3d)"' motion/skeleton.cpp
if sources | xargs grep -nE '== "(tiny|small|base|paper|momask)"'; then
  fail "presets are compared as strings; use ModelSize and parse_preset() of base/preset.h"
fi

sed -n '/^## Embed it/,/^```$/p' README.md | sed '1,/^```cpp$/d;/^```$/d' >"${TMPDIR:-/tmp}/readme_program.$$"
cmp -s "${TMPDIR:-/tmp}/readme_program.$$" examples/readme.cpp ||
  fail "the program of README.md is not examples/readme.cpp"
lines=$(wc -l <examples/readme.cpp)
[ "$lines" -le 12 ] || fail "the program of README.md has $lines lines; 12 are allowed"
rm -f "${TMPDIR:-/tmp}/readme_program.$$"
[ "$failed" = 0 ] && echo "the plan holds: a path of $steps files, one place each for evidence, skeletons and presets"
exit $failed
