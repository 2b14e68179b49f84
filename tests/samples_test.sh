#!/bin/bash
# Runs every sample of examples/ on the shipped files, and compiles the program of README.md alone.
#   tests/samples_test.sh BUILD_FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export REMOMASK_MODELS=$root/models
cp "$REMOMASK_MODELS"/motions.sqlite* "$work"
cd "$work"
model=$REMOMASK_MODELS/base.safetensors
sample() {
  name=$1
  shift
  "$build/examples/sample_$name" "$@" >"$name.txt" || { cat "$name.txt"; echo "sample_$name failed" >&2; exit 1; }
}
says() { grep -q -e "$2" "$1.txt" || { cat "$1.txt"; echo "sample_$1 does not say \"$2\"" >&2; exit 1; }; }

sample search "$model" motions.sqlite "a person jumps"
says search '^1\. .*jump'
sample generate_with_evidence "a person walks forward" walk.bvh
says generate_with_evidence '^read .*followed'
grep -q '"schema": "remomask.motion/1"' walk.bvh.json
sample search_by_example "$model" motions.sqlite walk.bvh
says search_by_example 'described by: '
says search_by_example 'arms like it: '
sample edit_a_span walk.bvh 0.5 1.5 "someone waves" waving.bvh
says edit_a_span 'left_arm: frames 10 to 30'
sample long_script day.bvh
says long_script '3 of 3'
grep -q '^Frames: 160' day.bvh
sample stream_rotations "a person waves the right hand"
[ "$(grep -c right_elbow stream_rotations.txt)" = 40 ]
sample add_clips "$model" motions.sqlite waving.bvh "an acrobat somersaults"
says add_clips '^added waving'
says add_clips '^found: waving'
sample readme
grep -q '^ROOT' wave.bvh
"$build/tools/remomask" --quiet procedural --db small.sqlite --count 60 >/dev/null
sample train_your_own small.sqlite run tiny 2
says train_your_own 'run/model.safetensors'
[ -s run/model.safetensors ]

# The program of README.md: at most 12 lines, and compiled without the headers of libtorch. The time
# is printed, not checked: other work may be going on.
for i in 1 2 3; do
  start=$(date +%s.%N)
  c++ -std=c++20 -I "$root/include" -c "$root/examples/readme.cpp" -o readme.o
  awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { printf "README program compiled in %.2f s\n", b - a }'
done
