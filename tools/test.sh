#!/bin/bash
# Installs what is missing, builds everything with warnings as errors, and runs all checks and
# tests, what fails soonest first. This is what continuous integration runs.
#   tools/test.sh [STEP...]     only these steps; their names are printed as they run
set -euo pipefail
cd "$(dirname "$0")/.."
chosen=" $* "
begin=$SECONDS

# step NAME COMMAND...: prints the step and how long it took.
step() {
  local name=$1 start=$SECONDS
  shift
  [ "$chosen" = "  " ] || [[ $chosen == *" $name "* ]] || return 0
  echo "== $name"
  "$@"
  echo "== $name: $((SECONDS - start)) s"
}

check_format() {
  find . -path ./build -prune -o \( -name '*.h' -o -name '*.cpp' \) -print |
     xargs clang-format-14 --dry-run --Werror
}

# The rooms without libtorch, whose tests also build fast enough to be built twice.
sanitize() {
  cmake --preset asan >/dev/null
  cmake --build build/asan -j "${JOBS:-$(nproc)}" --target base_tests motion_tests db_tests
  ctest --test-dir build/asan -R '^(base|motion|db)$' --parallel "${JOBS:-$(nproc)}" --output-on-failure --timeout 1800
}

step packages tools/install_debian.sh --checks
step includes tests/check_includes.sh
step rooms tools/draw_rooms.sh --check
step headers tests/check_headers.sh
# Debian 13 has other versions, with other opinions.
if command -v clang-format-14 >/dev/null && command -v clang-tidy-14 >/dev/null; then
  step format check_format
  step lint tools/lint.sh
fi
# With the benchmarks, which add a sixteenth to the compile time and break unseen otherwise.
step build tools/build.sh tests -DREMOMASK_WERROR=ON
# Most tests run one process of one thread after another.
step tests ctest --test-dir build/release --parallel "${JOBS:-$(nproc)}" --output-on-failure --timeout 1800
step sanitizers sanitize
echo "all steps: $((SECONDS - begin)) s"
