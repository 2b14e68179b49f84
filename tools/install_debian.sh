#!/bin/sh
# Installs what remomask needs on Debian 12 or 13, and nothing else. Run as root, or as a
# user who may use sudo.
#   tools/install_debian.sh [--checks]      with the tools of the checks in tools/test.sh
set -eu
as_root=""
[ "$(id -u)" = 0 ] || as_root="sudo"
# The names are the same in both releases.
packages="g++ cmake ninja-build ccache pkg-config
  libtorch-dev libfaiss-dev libopenblas-pthread-dev libsqlite3-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libeigen3-dev libxxhash-dev
  libarchive-dev libtinygltf-dev libassimp-dev libcairo2-dev libutf8proc-dev fonts-dejavu-core libgtest-dev libbenchmark-dev"
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case $release in
  bookworm | trixie) ;;
  *) echo "tools/install_debian.sh knows Debian 12 and 13, not \"$release\": trying" >&2 ;;
esac
if [ "${1:-}" = --checks ]; then
  packages="$packages git file dpkg-dev"
  # Their output differs between versions, and Debian 13 has none of version 14: the code is
  # formatted and checked by those of Debian 12.
  [ "$release" != bookworm ] || packages="$packages clang-format-14 clang-tidy-14"
fi
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
