#!/bin/sh
# Installs what is missing, builds everything and runs all tests.
set -eu
cd "$(dirname "$0")/.."
tools/install_debian.sh
tools/build.sh tests
python3 tests/check_includes.py
ctest --test-dir build/release --output-on-failure --timeout 600
