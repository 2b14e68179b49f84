#!/bin/sh
# Lists what a shared library exports and fails for anything but the public interface: names
# of namespace remomask itself (not of a room), type information and virtual tables of them.
#   tests/check_symbols.sh libremomask.so
set -eu
library=$1
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | c++filt -i)
rooms=$("$(dirname "$0")/../tools/draw_rooms.sh" --rooms | tr ' ' '|')
wrong=$(printf '%s\n' "$exported" |
  grep -vE '^((non-virtual thunk|typeinfo|typeinfo name|vtable|VTT|construction vtable|guard variable) for )?remomask::' ||
  true)
inner=$(printf '%s\n' "$exported" | grep -E "^([a-z ]+ for )?remomask::($rooms|\(anonymous namespace\))::" || true)
if [ -n "$wrong$inner" ]; then
  printf '%s\n' "$wrong" "$inner" | grep . | head -n 40 >&2
  echo "$library exports what is not part of the interface" >&2
  exit 1
fi
printf '%s\n' "$exported" | grep -q '^remomask::TextToMotion::generate' ||
  { echo "$library does not export remomask::TextToMotion::generate" >&2; exit 1; }
echo "$(printf '%s\n' "$exported" | wc -l) exported symbols, all of the public interface"
