#!/bin/bash
# Kills the program with SIGKILL at random moments while it writes a database,
# and looks after each kill whether anything was lost or broken:
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
  local start
  start=$(date +%s%3N)
  "$remomask" --quiet index "$database" >/dev/null
  duration[index]=$(($(date +%s%3N) - start))
  next_batch=1
  names >"$work/before"
}

# Runs a command and kills it after a random part of the time that such commands
# take. Sets `outcome` to acknowledged, or to killed when it did not say it succeeded.
run_and_kill() {
  local start end allowed delay pid
  allowed=${duration[$operation]:-1500}
  delay=$((RANDOM % (allowed + allowed / 5 + 1)))
  start=$(date +%s%3N)
  "$remomask" --quiet "$@" >"$work/output" 2>"$work/errors" &
  pid=$!
  # A command that has ended is not waited for.
  timeout "$(awk "BEGIN{print $delay / 1000 + 0.001}")" \
    tail --pid="$pid" -s 0.02 -f /dev/null || true
  kill -9 "$pid" 2>/dev/null || true
  local status=0
  wait "$pid" 2>/dev/null || status=$?
  end=$(date +%s%3N)
  if [ "$status" = 0 ] || grep -q '[a-z]' "$work/output"; then
    outcome=acknowledged
    duration[$operation]=$((end - start))
  elif [ "$status" = 137 ]; then
    outcome=killed
    # Else an operation that never gets to its end would never be seen to.
    duration[$operation]=$((allowed + allowed / 4))
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

declare -A duration killed finished
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
  echo "  $name: ${killed[$name]:-0} killed, ${finished[$name]:-0} had ended before"
done
echo "  $half of the killed ones had stored all or part of their work"
echo "nothing acknowledged was lost, every check passed, searches equal those of a fresh index"
