#!/bin/bash
# Gives every reader mutated inputs under AddressSanitizer and UndefinedBehaviorSanitizer, in
# rounds of 140,000; a round gets other inputs than the rounds before it.
#   tools/fuzz.sh ROUNDS [FIRST]    FIRST: number of the first round, to go on where a run ended
# Needs build/asan with the target fuzz_tests (REMOMASK_FUZZ names another program).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=${REMOMASK_FUZZ:-$root/build/asan/tests/fuzz_tests}
first=${2:-0}
export REMOMASK_FUZZ_INPUTS=100
[ ! -w /dev/shm ] || export TMPDIR=${TMPDIR:-/dev/shm}
total=0
for ((round = first; round < first + $1; ++round)); do
  log=$(REMOMASK_FUZZ_FROM=$((round * REMOMASK_FUZZ_INPUTS)) "$program" 2>&1) || {
    printf '%s\n' "$log"
    echo "round $round: failed"
    exit 1
  }
  inputs=$(awk '/^fuzz:/ { sum += $2 } END { print sum }' <<<"$log")
  total=$((total + inputs))
  echo "round $round: $inputs inputs, $total in all, $SECONDS s"
done
