#!/bin/sh
# Compiles every public header by itself, with nothing but FOLDER on the path, and checks that
# neither libtorch nor Eigen nor a JSON library is among the files that it includes.
#   tests/check_headers.sh [FOLDER]          default: include; else PREFIX/include
set -eu
folder=$(cd "${1:-$(dirname "$0")/../include}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
count=0
for header in "$folder"/remomask/*.h; do
  name=remomask/$(basename "$header")
  # Twice: a header without include guard fails.
  printf '#include "%s"\n#include "%s"\n' "$name" "$name" >unit.cpp
  "${CXX:-c++}" -I "$folder" -std=c++20 -Wall -Wextra -Wshadow -Werror -fsyntax-only -H unit.cpp \
    2>included || { grep -v '^\.' included >&2; echo "$name does not compile by itself" >&2; exit 1; }
  if grep -E '^\.+ .*(torch|ATen|c10|Eigen|eigen3|nlohmann|faiss|sqlite)' included; then
    echo "$name includes what a program that uses the library need not have" >&2
    exit 1
  fi
  count=$((count + 1))
done
[ "$count" -gt 0 ] || { echo "no headers in $folder/remomask" >&2; exit 1; }
echo "$count public headers compile alone"
