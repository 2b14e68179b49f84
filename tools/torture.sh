#!/bin/bash
# Kills the program with SIGKILL at random moments, four of five between its first
# write and its answer, and looks after each kill whether anything was lost or broken:
#   - remomask db check finds no defect;
#   - a command that said it had succeeded is stored as a whole; of one that was
#     killed, an add or import left whole files, a tag or remove all or nothing;
#   - now and then: a search answers, or says that the index is out of date.
# At the end the index is brought up to date, and searches with it must give what
# they give with an index that is made anew.
#   tools/torture.sh [ROUNDS [SEED]]          100 rounds, some 5 to 20 minutes
#   tools/torture.sh --readers [SECONDS]      one process writes, three read: 300 s
# REMOMASK names another program, REMOMASK_BUILD another build folder than
# build/release, TORTURE_FOLDER a folder to keep instead of a temporary one.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=${REMOMASK_BUILD:-$root/build/release}
remomask=${REMOMASK:-$build/tools/remomask}
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1}
export LC_ALL=C

if [ "${1:-}" = --readers ]; then
  export REMOMASK_SOAK_SECONDS=${2:-300}
  exec "$build/tests/db/db_tests" --gtest_filter='TwoProcesses.*'
fi

rounds=${1:-100}
RANDOM=${2:-1}
if [ -n "${TORTURE_FOLDER:-}" ]; then
  work=$TORTURE_FOLDER
  mkdir -p "$work"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
database=$work/work.sqlite
pool=$work/pool
batch_size=6

fail() {
  echo "round $round ($operation): $*" >&2
  echo "the database is $database" >&2
  trap - EXIT
  exit 1
}

# Names of the clips that pass the filters, sorted.
names() { "$remomask" db list "$database" "$@" | awk '/ m\/s /{print $7}' | sort; }

# Lines of FILE, at most COUNT of them, in random order.
some_of() {
  local seed=$RANDOM  # of this shell: those in a pipe have their own
  awk -v seed="$seed" 'BEGIN{srand(seed)} {print rand() "\t" $0}' "$1" | sort -n | cut -f2 |
    head -n "$2"
}

# A pool of clips as files, and folders of a few for imports.
prepare() {
  "$remomask" --quiet procedural --db "$work/source.sqlite" --count 120 >/dev/null
  "$remomask" --quiet db export "$work/source.sqlite" "$pool" >/dev/null
  mkdir -p "$work/batches"
  local batch=0 line stem
  while IFS= read -r line; do
    stem=$(sed -E 's/^\{"clip":"([^"]*)".*/\1/' <<<"$line")
    local folder=$work/batches/$((batch / batch_size))
    mkdir -p "$folder"
    cp "$pool/$stem.npy" "$folder/"
    echo "$line" >>"$folder/captions.jsonl"
    batch=$((batch + 1))
  done < <(head -n 60 "$pool/captions.jsonl")
  tail -n 60 "$pool/captions.jsonl" | sed -E 's/^\{"clip":"([^"]*)".*/\1/' | sort >"$work/files"
  batches=$((60 / batch_size))
  "$remomask" --quiet import "$work/batches/0" --db "$database" >/dev/null
  "$remomask" --quiet index "$database" >/dev/null
  next_batch=1
  names >"$work/before"
}

# True when a file of the database or its index was written since the marker was made.
writing() {
  [ -s "$database-wal" ] && [ "$database-wal" -nt "$work/marker" ] && return 0
  [ "$database.index" -nt "$work/marker" ] || [ "$database.index.delta" -nt "$work/marker" ] ||
    compgen -G "$database.index*.tmp-*" >/dev/null
}

# True while the program runs and has not answered.
working() { [ ! -s "$work/output" ] && kill -0 "$1" 2>/dev/null; }

# Waits for a part of the microseconds `$2`, or until program `$1` has answered.
wait_part() {
  local end=$((${EPOCHREALTIME/./} + (RANDOM * 32768 + RANDOM) % ($2 + $2 / 5 + 1)))
  # No sleep is as short as a commit.
  while [ "${EPOCHREALTIME/./}" -lt "$end" ] && working "$1"; do :; done
}

# Runs a command and kills it, most often after a random part of the time that such
# commands take from their first write to their answer, else of their whole time. Sets
# `outcome` to acknowledged, or to killed when it did not say it succeeded.
run_and_kill() {
  local phase=$operation.whole begun=0 start pid status=0
  touch "$work/marker"
  : >"$work/output"
  "$remomask" --quiet "$@" >"$work/output" 2>"$work/errors" &
  pid=$!
  if [ $((RANDOM % 5)) != 0 ]; then
    phase=$operation.writing
    until writing || ! working "$pid"; do :; done
    ! writing || begun=1
  fi
  start=${EPOCHREALTIME/./}  # in microseconds
  local allowed=${duration[$phase]:-${expected[${phase#*.}]}}
  wait_part "$pid" "$allowed"
  local answered=0
  working "$pid" || answered=$((${EPOCHREALTIME/./} - start))
  kill -9 "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || status=$?
  if [ "$status" = 0 ] || [ -s "$work/output" ]; then
    outcome=acknowledged
    [ "$answered" = 0 ] || duration[$phase]=$answered
  elif [ "$status" = 137 ]; then
    outcome=killed
    # Else an operation that never gets to its end would never be seen to.
    duration[$phase]=$((allowed + allowed / 4))
    if [ "$begun" = 1 ] || writing; then
      in_writing[$operation]=$((${in_writing[$operation]:-0} + 1))
    fi
  else
    fail "ended with $status: $(cat "$work/errors")"
  fi
}

# The clips now in the database are those before and, all or some (`whole`: all or
# none) of `changed`, added or removed by `sign`; all when it said it was done.
expect_clips() {
  local sign=$1 whole=$2
  names >"$work/now"
  if [ "$sign" = + ]; then
    comm -23 "$work/before" "$work/now" >"$work/wrong"
    comm -13 "$work/before" "$work/now" >"$work/difference"
  else
    comm -13 "$work/before" "$work/now" >"$work/wrong"
    comm -23 "$work/before" "$work/now" >"$work/difference"
  fi
  [ -s "$work/wrong" ] && fail "lost or found: $(tr '\n' ' ' <"$work/wrong")"
  comm -23 "$work/difference" <(sort "$work/changed") >"$work/wrong"
  [ -s "$work/wrong" ] && fail "clips changed that were not meant: $(tr '\n' ' ' <"$work/wrong")"
  local changed asked
  changed=$(wc -l <"$work/difference")
  asked=$(wc -l <"$work/changed")
  if [ "$outcome" = acknowledged ] && [ "$changed" != "$asked" ]; then
    fail "it said it had succeeded, but $changed of $asked clips changed"
  fi
  if [ "$whole" = whole ] && [ "$changed" != 0 ] && [ "$changed" != "$asked" ]; then
    fail "$changed of $asked clips changed, not all or none"
  fi
  [ "$outcome" = killed ] && [ "$changed" != 0 ] && half=$((half + 1))
  mv "$work/now" "$work/before"
}

try_add() {
  comm -23 "$work/files" "$work/before" >"$work/absent"
  some_of "$work/absent" 4 >"$work/changed"
  [ -s "$work/changed" ] || { try_remove; return; }
  local files=()
  while IFS= read -r name; do files+=("$pool/$name.npy"); done <"$work/changed"
  run_and_kill db add "$database" "${files[@]}" \
    --caption "a person moves in round $round" --tag added
  expect_clips + some
}

try_remove() {
  operation=remove
  # Those of the folders stay: an import knows its files and would not bring them back.
  comm -12 "$work/files" "$work/before" >"$work/present"
  some_of "$work/present" 3 >"$work/changed"
  [ -s "$work/changed" ] || { operation=add; try_add; return; }
  local clips=()
  while IFS= read -r name; do clips+=("$name"); done <"$work/changed"
  run_and_kill db remove "$database" "${clips[@]}" --yes
  expect_clips - whole
}

try_import() {
  [ "$next_batch" -lt "$batches" ] || { operation=add; try_add; return; }
  local folder=$work/batches/$next_batch
  comm -23 <(sed -E 's/^\{"clip":"([^"]*)".*/\1/' "$folder/captions.jsonl" | sort) \
    "$work/before" >"$work/changed"
  run_and_kill import "$folder" --db "$database"
  expect_clips + some
  # What was killed is imported again, until it is done.
  [ "$outcome" = acknowledged ] && next_batch=$((next_batch + 1))
  return 0
}

try_tag() {
  some_of "$work/before" 5 | sort >"$work/changed"
  local clips=()
  while IFS= read -r name; do clips+=("$name"); done <"$work/changed"
  run_and_kill db tag "$database" "${clips[@]}" --add "round$round"
  local tagged=0
  # A tag that no clip has is an error of the filter.
  if names --tag "round$round" >"$work/tagged" 2>/dev/null; then tagged=$(wc -l <"$work/tagged"); fi
  if [ "$tagged" != 0 ] && ! cmp -s "$work/tagged" "$work/changed"; then
    fail "other clips are tagged than were meant"
  fi
  [ "$outcome" = acknowledged ] && [ "$tagged" = 0 ] &&
    fail "it said it had succeeded, but nothing is tagged"
  [ "$outcome" = killed ] && [ "$tagged" != 0 ] && half=$((half + 1))
  : >"$work/changed"
  local outcome=killed
  expect_clips + whole
}

try_index() {
  run_and_kill index "$database"
  : >"$work/changed"
  local outcome=killed
  expect_clips + whole
}

declare -A duration killed finished in_writing
declare -A expected=([whole]=1500000 [writing]=20000)  # microseconds
half=0
searches=0
answered=0
round=0
operation=prepare
began=$(date +%s)
prepare
operations=(add remove import tag index)
for ((round = 1; round <= rounds; ++round)); do
  operation=${operations[RANDOM % 5]}
  "try_$operation"
  if [ "$outcome" = acknowledged ]; then
    finished[$operation]=$((${finished[$operation]:-0} + 1))
  else
    killed[$operation]=$((${killed[$operation]:-0} + 1))
  fi
  "$remomask" --quiet db check "$database" >"$work/check" || fail "db check: $(cat "$work/check")"
  # Starting a search costs more than all of the above: not after every round.
  if [ "$operation" = index ] || [ $((round % 10)) = 0 ]; then
    status=0
    "$remomask" search "a person walks" --db "$database" >"$work/hits" 2>"$work/errors" || status=$?
    if [ "$status" = 0 ]; then
      answered=$((answered + 1))
    elif [ "$status" != 1 ] || ! grep -q "remomask index" "$work/errors"; then
      fail "search ended with $status: $(cat "$work/errors")"
    fi
    searches=$((searches + 1))
  fi
done

operation=end
search_all() {
  local query
  for query in "a person walks" "someone bows" "a jump" "turns left slowly" "moves in round"; do
    "$remomask" search "$query" -k 20 --ungrouped --db "$database" --json
  done
}
"$remomask" --quiet index "$database" >/dev/null
search_all >"$work/searched"
rm -rf "$database.index"*
"$remomask" --quiet index "$database" >/dev/null
search_all >"$work/fresh"
cmp "$work/searched" "$work/fresh" || fail "searches with a fresh index give something else"
"$remomask" --quiet db check "$database"
echo "$rounds rounds in $(($(date +%s) - began)) s; $answered of $searches searches found a current index"
for name in "${operations[@]}"; do
  echo "  $name: ${killed[$name]:-0} killed, ${in_writing[$name]:-0} of them while writing; ${finished[$name]:-0} had ended before"
  all_killed=$((${all_killed:-0} + ${killed[$name]:-0}))
  all_in_writing=$((${all_in_writing:-0} + ${in_writing[$name]:-0}))
done
echo "  $all_in_writing of $all_killed kills hit between the first write and the answer"
echo "  $half of the killed ones had stored all or part of their work"
echo "nothing acknowledged was lost, every check passed, searches equal those of a fresh index"
