#!/bin/bash
# Builds and tests the project in a clean Debian root of its own, so that both supported
# releases can be checked on one machine. Needs root, debootstrap and 4 GB of disk. The
# root is kept and reused: a second run compiles only what has changed.
#   tools/build_in_root.sh [--bare] bookworm|trixie FOLDER [COMMAND...]
# COMMAND runs in the copy of the checkout instead of tools/test.sh; with --bare there is no
# copy, and it runs in /. JOBS=1 limits the compiler processes, MIRROR names another archive.
set -euo pipefail
bare=""
if [ "${1:-}" = --bare ]; then
  bare=--bare
  shift
fi
release=${1:-}
folder=${2:-}
if [ $# -lt 2 ] || { [ "$release" != bookworm ] && [ "$release" != trixie ]; }; then
  echo "usage: $0 [--bare] bookworm|trixie FOLDER [COMMAND...]" >&2
  exit 2
fi
shift 2
[ "$(id -u)" = 0 ] || { echo "$0 needs root, for debootstrap and chroot: run it by sudo" >&2; exit 1; }
command -v debootstrap >/dev/null ||
  { echo "debootstrap is missing: apt-get install debootstrap" >&2; exit 1; }
source=$(cd "$(dirname "$0")/.." && pwd)

if [ ! -f "$folder/etc/apt/remomask_ready" ]; then
  # Without MIRROR, the archive that debootstrap knows.
  debootstrap --variant=minbase "$release" "$folder" ${MIRROR:+"$MIRROR"}
  # The way to the network that this machine uses: proxies, mirrors, checks of dates.
  apt-config dump | grep -E '^Acquire::(Check-|https?::|Retries)' \
    >"$folder/etc/apt/apt.conf.d/90host" || true
  echo 'Binary::apt-get::APT::Keep-Downloaded-Packages "false";' \
    >"$folder/etc/apt/apt.conf.d/91small"
  touch "$folder/etc/apt/remomask_ready"
fi
folder=$(cd "$folder" && pwd)
cp -L /etc/resolv.conf "$folder/etc/resolv.conf"

# Whatever is mounted below is gone with this mount namespace, even after a kill.
if [ -z "${REMOMASK_IN_NAMESPACE:-}" ]; then
  REMOMASK_IN_NAMESPACE=1 exec unshare --mount --propagation private \
    "$0" ${bare:+"$bare"} "$release" "$folder" "$@"
fi
mount --bind /proc "$folder/proc"
mount --bind /dev "$folder/dev"

# The files of the checkout as they are now, without ignored ones. Those that did not
# change keep their times, so that nothing is compiled twice.
copy_checkout() {
  local list file
  list=$(mktemp)
  (cd "$source" && git ls-files -z --cached --others --exclude-standard | tr '\0' '\n' |
    while IFS= read -r file; do [ ! -e "$file" ] || echo "$file"; done) | sort >"$list"
  mkdir -p "$1"
  (cd "$1" && find . -path ./build -prune -o -type f -print | sed 's|^\./||' | sort) |
    comm -23 - "$list" | while IFS= read -r file; do rm -f "$1/$file"; done
  while IFS= read -r file; do
    cmp -s "$source/$file" "$1/$file" ||
      { mkdir -p "$1/$(dirname "$file")"; cp -p "$source/$file" "$1/$file"; }
  done <"$list"
  rm -f "$list"
}

start=/
if [ -z "$bare" ]; then
  start=/root/remomask
  copy_checkout "$folder$start"
fi
if [ $# = 0 ]; then
  set -- tools/test.sh
fi
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 ${JOBS:+JOBS="$JOBS"} \
  chroot "$folder" /bin/sh -c 'cd "$0" && exec "$@"' "$start" "$@"
