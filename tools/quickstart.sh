#!/bin/sh
# From a fresh Debian 12 or 13 to a generated motion: installs, builds, generates.
set -eu
cd "$(dirname "$0")/.."
prompt=${1:-"a person walks forward, then waves with the right hand"}
tools/install_debian.sh
tools/build.sh
build/release/tools/remomask generate "$prompt" --seed 7 -o motion.bvh --sheet motion.png
