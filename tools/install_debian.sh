#!/bin/sh
# Installs what remomask needs on Debian 12, and nothing else. Run as root, or
# as a user who may use sudo.
set -eu
as_root=""
[ "$(id -u)" = 0 ] || as_root="sudo"
packages="g++ cmake ninja-build ccache pkg-config
  libtorch-dev libfaiss-dev libopenblas-pthread-dev libsqlite3-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libeigen3-dev libxxhash-dev
  libarchive-dev libcairo2-dev fonts-dejavu-core libgtest-dev libbenchmark-dev"
missing=""
for package in $packages; do
  dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null | grep -q '^ii' ||
    missing="$missing $package"
done
[ -n "$missing" ] || exit 0
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get -o DPkg::Lock::Timeout=300 -q update
# Recommended packages stay out: they would double the size.
# shellcheck disable=SC2086
$as_root apt-get -o DPkg::Lock::Timeout=300 -q install -y --no-install-recommends $missing
