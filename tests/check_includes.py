#!/usr/bin/env python3
"""Checks that #include goes only downward: a room may use the rooms above it
in the list of CMakeLists.txt, never those below."""
import pathlib
import re
import sys

ROOMS = ["base", "motion", "db", "nn", "text", "retriever", "index", "generator", "evaluation",
         "tools"]


def violations(root):
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in (".h", ".cpp", ".in"):
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = re.match(r'\s*#include\s+"([a-z_]+)/', line)
                if not found:
                    continue
                used = found.group(1)
                if used not in ROOMS or ROOMS.index(used) > ROOMS.index(room):
                    yield f"{path.relative_to(root)}:{number}: {room} must not use {used}"
            if room in ("base", "motion", "db"):
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    if re.match(r"\s*#include\s+<(torch|ATen|c10)/", line):
                        yield f"{path.relative_to(root)}:{number}: {room} must not use libtorch"


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    found = list(violations(root))
    for line in found:
        print(line)
    print(f"{len(found)} includes go upward" if found else "all includes go downward")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
