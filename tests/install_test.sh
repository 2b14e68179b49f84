#!/bin/bash
# Installs BUILD_FOLDER into a temporary prefix, moves it, and uses it as a stranger would:
# headers, symbols, find_package, pkg-config, program, models, manual page, completion.
#   tests/install_test.sh BUILD_FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset REMOMASK_MODELS
fail() {
  echo "$*" >&2
  exit 1
}

cmake --install "$build" --prefix "$work/staged" >/dev/null
# The installed tree must work wherever it is.
prefix=$work/moved
mv "$work/staged" "$prefix"
library=$(find "$prefix" -name 'libremomask.so' -o -name 'libremomask.a')
libdir=$(dirname "$library")

for file in bin/remomask include/remomask/text_to_motion.h share/remomask/base.safetensors \
  share/remomask/evaluator.safetensors share/remomask/motions.sqlite \
  share/remomask/motions.sqlite.index share/remomask/skeleton_maps.json \
  share/remomask/README.md share/doc/remomask/README.md share/doc/remomask/LICENSE \
  share/doc/remomask/CHANGELOG.md share/doc/remomask/docs/search.md \
  share/doc/remomask/examples/CMakeLists.txt share/man/man1/remomask.1 \
  share/bash-completion/completions/remomask; do
  [ -s "$prefix/$file" ] || fail "$file is not installed"
done
# In text and in binaries alike. The build folder is inside of the source tree.
if grep -rl --exclude-dir=doc -F "$root" "$prefix" || grep -rl -F "$build" "$prefix"; then
  fail "the installed files above name the source tree"
fi
for binary in "$prefix/bin/remomask" "$library" "$libdir"/remomask/*.so; do
  [ -e "$binary" ] || continue
  paths=$(readelf -d "$binary" 2>/dev/null | sed -nE 's/.*(RPATH|RUNPATH).*\[(.*)\]/\2/p')
  case $paths in
    '' | "\$ORIGIN"*) ;;
    *) fail "$binary looks for libraries in $paths" ;;
  esac
done

"$root/tests/check_headers.sh" "$prefix/include"
[ "${library##*.}" != so ] || "$root/tests/check_symbols.sh" "$library"

# The examples as a project of their own. Nothing of the source tree may be needed.
cp -r "$root/examples" "$work/source"
launcher=$(command -v ccache || true)
cmake -S "$work/source" -B "$work/examples" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} \
  >"$work/log" || { cat "$work/log"; exit 1; }
[ "${library##*.}" != so ] || ! grep -qi torch "$work/examples/CMakeCache.txt" ||
  fail "a user of the shared library must not need libtorch's CMake files"
cmake --build "$work/examples" -j 2 >"$work/log" || { cat "$work/log"; exit 1; }
shipped=$prefix/share/remomask
"$work/examples/sample_search" "$shipped/base.safetensors" "$shipped/motions.sqlite" \
  "a person waves the right hand" | tee "$work/found"
grep -q wav "$work/found"
(cd "$work" && "$work/examples/sample_generate_with_evidence" "a person waves" motion.bvh)
grep -q '^Frames: ' "$work/motion.bvh"

# A program by pkg-config.
cat >"$work/waves.cpp" <<'END'
#include <remomask/error.h>
#include <remomask/library.h>
#include <remomask/text_to_motion.h>

#include <cstdio>

int main() {
  const remomask::TextToMotion remomask(remomask::shipped_model(), remomask::shipped_database());
  remomask::SearchQuery query;
  query.text = "a person waves the right hand";
  query.k = 1;
  const remomask::SearchAnswer answer = remomask.search(query);
  std::puts(answer.hits.at(0).clip.captions.at(0).c_str());
  try {
    remomask::TextToMotion("nowhere", "nowhere");
  } catch (const remomask::Error& error) {  // by type, across the border of the library
    return 0;
  }
  return 1;
}
END
export PKG_CONFIG_PATH=$libdir/pkgconfig
version=$(sed -nE 's/^#define REMOMASK_VERSION "(.*)"/\1/p' "$prefix/include/remomask/version.h")
[ "$(pkg-config --modversion remomask)" = "$version" ] || fail "remomask.pc is not of version $version"
# shellcheck disable=SC2046
c++ -std=c++20 "$work/waves.cpp" -o "$work/waves" $(pkg-config --cflags --libs remomask)
LD_LIBRARY_PATH=$libdir "$work/waves" | tee "$work/found"
grep -q wav "$work/found"

# The program, from another folder, with the installed models.
cd "$work"
remomask=$prefix/bin/remomask
"$remomask" --version
"$remomask" search "a person waves the right hand" -k 1 >found
grep -q wav found

# Every command is in the manual page and in the completion.
completion=$prefix/share/bash-completion/completions/remomask
commands=$("$remomask" --help | awk '/^[A-Z].*:$/ { on = /ommands:$/; next } on && /^  [a-z]/ { print $1 }')
[ -n "$commands" ] || fail "remomask --help lists no commands"
for command in $commands; do
  grep -q "^\.SH remomask ${command//-/\\\\-}\$" "$prefix/share/man/man1/remomask.1" ||
    fail "the manual page lacks $command"
  bash -c '. "$1"; COMP_WORDS=(remomask "$2"); COMP_CWORD=1; _remomask; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$completion" "${command:0:2}" | grep -x -e "$command" >/dev/null || fail "the completion lacks $command"
done
bash -c '. "$1"; COMP_WORDS=(remomask search --min-s); COMP_CWORD=2; _remomask; printf "%s\n" "${COMPREPLY[@]}"' \
  - "$completion" | grep -x -e --min-seconds >/dev/null || fail "the completion lacks options"

# It was the installed database, not that of the source tree.
echo damaged >"$prefix/share/remomask/motions.sqlite"
if "$remomask" search "a person waves the right hand" >found 2>&1; then
  fail "the installed program reads other files than the installed ones"
fi
grep -q "share/remomask/motions.sqlite" found || { cat found; exit 1; }
