#!/bin/bash
# Builds the Debian package, installs it in a fresh Debian root with nothing else in it, and
# uses the program there. Needs root and debootstrap; a build in build/release.
#   tools/package_test.sh [bookworm|trixie]     default: the release of this machine
set -euo pipefail
cd "$(dirname "$0")/.."
release=${1:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
(cd build/release && cpack -G DEB -B "$work/package" >"$work/log") || { cat "$work/log"; exit 1; }
package=$(ls "$work"/package/*.deb)
dpkg-deb --info "$package"

# The root without the checkout: only the package may be needed.
tools/build_in_root.sh --bare "$release" "$work/root" true
cp "$package" "$work/root/root/remomask.deb"
tools/build_in_root.sh --bare "$release" "$work/root" sh -c '
  set -eu
  export DEBIAN_FRONTEND=noninteractive
  apt-get -q update
  apt-get -q install -y --no-install-recommends /root/remomask.deb libopenblas0-pthread
  cd /tmp
  remomask --version
  remomask search "a person waves the right hand" -k 1 | tee found
  grep -q wav found
  man_page=$(dpkg -L remomask | grep "/remomask\.1")
  [ -n "$man_page" ]'
echo "$(basename "$package") works on $release"
