#!/bin/sh
# What the momentum queues bring: trains the tiny retriever without queues, with
# the motion queue alone and with both, three seeds each at equal budget, and
# prints a Markdown table of the test split. Stopped runs go on where they were.
# More arguments go to the training, for example --same-label-weight 0.
#   tools/queue_ablation.sh motions.sqlite FOLDER [OPTION...]
set -eu
[ $# -ge 2 ] || { echo "usage: $0 DATABASE FOLDER [OPTION...]" >&2; exit 2; }
database=$1
folder=$2
shift 2
remomask=${REMOMASK:-$(dirname "$0")/../build/release/tools/remomask}
settings="--preset tiny --steps 400 --batch 64 --rate 0.002 --queue-size 2048 $*"
mkdir -p "$folder"
for seed in 1 2 3; do
  for queues in none motion both; do
    run="$folder/$queues-$seed"
    # shellcheck disable=SC2086
    [ -f "$run/retriever.safetensors" ] ||
      "$remomask" train retriever --db "$database" -o "$run" $settings --queues "$queues" \
        --seed "$seed" >/dev/null
    [ -f "$run/test.txt" ] || {
      "$remomask" --quiet evaluate retrieval --protocol duplicates --db "$database" \
        --model "$run/retriever.safetensors" >"$run/test.tmp"
      mv "$run/test.tmp" "$run/test.txt"
    }
  done
done
echo "\`remomask train retriever $settings\`, seeds 1 to 3, mean (min to max), percent;"
sed -n 2,4p "$folder/none-1/test.txt"
echo
echo "| queues | queries | direction | R@1 | R@3 | R@10 | first hit: content | content and style |"
echo "|---|---|---|---|---|---|---|---|"
for subset in take pair all; do
  for direction in text-to-motion motion-to-text; do
    for queues in none motion both; do
      cat "$folder/$queues"-[123]/test.txt | awk -v subset=$subset -v direction=$direction \
        -v queues=$queues '
        function note(i, value) {
          sum[i] += value; ++count[i]
          if (count[i] == 1 || value < least[i]) least[i] = value
          if (count[i] == 1 || value > most[i]) most[i] = value
        }
        $1 == subset && $3 == direction { note(1, $4); note(2, $8); note(3, $12) }
        $1 == subset && $2 == "labels" && $4 == direction { note(4, $5); note(5, $6) }
        END {
          printf "| %s | %s | %s |", queues, subset, direction
          for (i = 1; i <= 5; ++i) printf " %.1f (%.1f-%.1f) |", sum[i] / count[i], least[i], most[i]
          printf "\n"
        }'
    done
  done
done
