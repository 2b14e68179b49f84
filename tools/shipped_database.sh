#!/bin/bash
# Builds the database that ships, from the packs of motion capture that may be used freely and the
# motions that are made by formula, with its index:
#   tools/shipped_database.sh DATA_FOLDER OUT.sqlite
# DATA_FOLDER holds NAME.tar.xz and NAME.jsonl of the packs below. The index is that of the shipped
# model (REMOMASK_MODELS chooses another folder of models), REMOMASK another program.
set -euo pipefail
[ $# = 2 ] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "$0")/.." && pwd)
data=$1
out=$2
remomask=${REMOMASK:-$here/build/release/tools/remomask}
most_bytes=45000000

# Licences CMU, MIT and Apache-2.0. HDM05 is free, too, but share-alike: all of the database would be.
packs="cmu_daz cmu_conv cmu_alt deepmimic misc cmu2"
free_licences="CMU MIT Apache-2.0"

# Of the kinds that captured clips show better one stays, so that every kind can be tried; of the
# others (clapping, limping, raising one hand, turns on the spot ...) four.
captured_kinds="walk-forward walk-slow walk-fast walk-backward walk-stop walk-turn-left
  walk-turn-right jog run sprint sneak step-over stand jump-small jump-high jump-forward
  jumping-jacks squat kick-front-left kick-front-right punch-left punch-right punch-combination
  stretch sit-down sit-stand"
of_each_kind=4
kinds=59

# Minutes of idling, of which the first two windows say all, and two recordings that cmu2 holds in
# pieces with captions of their own.
left_out='^reactidle_.*#([2-9]|[0-9]{2,})$|^m21_(box-2|jumping-jack)(#.*)?$'

for file in "$out" "$out.index"; do
  [ ! -e "$file" ] || { echo "$file: exists already; remove it or name another file" >&2; exit 1; }
done
work=$(mktemp -d "$out.XXXXXX")
trap 'rm -rf "$work"' EXIT
captured=$work/captured.sqlite
database=$work/database.sqlite

archives=()
for pack in $packs; do archives+=("$data/$pack.tar.xz"); done
"$remomask" import "${archives[@]}" --db "$captured"
"$remomask" db remove "$captured" --licence CC-BY-NC-4.0 --yes >/dev/null
# The same trial on another skeleton, which the importer is tested with.
for original in $(grep -ho '"duplicate_of": "[^"]*"' "${archives[@]/%.tar.xz/.jsonl}" |
  sed 's/.*: "//; s/"$//' | sort -u); do
  "$remomask" db remove "$captured" --label "duplicate_of=$original" --yes >/dev/null
done
mapfile -t names < <("$remomask" --json db list "$captured" |
  grep -o '"name": *"[^"]*"' | sed 's/.*: *"//; s/"$//' | grep -E "$left_out")
"$remomask" db remove "$captured" "${names[@]}" --yes >/dev/null
licences=$("$remomask" db info "$captured" |
  awk '/^[^ ]/ { on = /^licences/ } /^ / && on { print $1 }')
for licence in $licences; do
  case " $free_licences " in
    *" $licence "*) ;;
    *) echo "$data: has clips of the licence $licence, which must not be shipped" >&2; exit 1 ;;
  esac
done

# Merging leaves the room of what was removed behind.
"$remomask" procedural --db "$database" --count $((of_each_kind * kinds))
surplus=()
for kind in $captured_kinds; do
  for ((number = 1; number < of_each_kind; ++number)); do
    surplus+=("procedural-$kind-$(printf %03d $number)")
  done
done
"$remomask" db remove "$database" "${surplus[@]}" --yes >/dev/null
"$remomask" db merge "$database" "$captured" >/dev/null
for source in procedural $packs; do
  "$remomask" db attribute "$database" "$source" "$(cat "$here/models/attributions/$source.txt")"
done

"$remomask" index "$database"
"$remomask" db check "$database"
bytes=$(($(stat -c %s "$database") + $(stat -c %s "$database.index")))
if [ "$bytes" -gt "$most_bytes" ]; then
  echo "$out: would have $bytes bytes with its index, more than $most_bytes" >&2
  exit 1
fi
mv "$database" "$out"
mv "$database.index" "$out.index"
"$remomask" db info "$out"
echo "$out: $bytes bytes with its index"
