#!/bin/sh
# Installs what is missing, builds everything and runs all tests.
set -eu
cd "$(dirname "$0")/.."
tools/install_debian.sh
tools/build.sh tests
tests/check_includes.sh
ctest --test-dir build/release --output-on-failure --timeout 600
