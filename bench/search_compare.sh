#!/bin/sh
# Exact search by this program, by raw FAISS and by NumPy in one run, with as
# many threads each: search_compare.sh BUILD_FOLDER [THREADS]
set -eu
build=${1:?usage: search_compare.sh BUILD_FOLDER [THREADS]}
threads=${2:-1}
here=$(dirname "$0")
export OMP_NUM_THREADS="$threads" OPENBLAS_NUM_THREADS="$threads"

python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import numpy' 2>/dev/null; then
    python=$candidate
    break
  fi
done

"$build/bench/search_bench" 2>/dev/null | grep -E 'Benchmark|_median'
if [ -n "$python" ]; then
  "$python" "$here/numpy_scan.py"
else
  echo "numpy: not installed, so it was not measured (Debian: apt-get install python3-numpy)"
fi
