#!/usr/bin/env bash
# clang-tidy over every C file, and the headers with them: tidy.sh SOURCE BUILD. What is checked, and
# what is not and why, is in .clang-tidy.
set -uo pipefail
cd "$1" || exit
build=$2
# Notes on "N warnings suppressed" go to stderr; findings, and what does not compile, to stdout.
find lib cmd tests -name '*.c' -not -path '*/node_modules/*' -print0 | sort -z |
    xargs -0 -n 4 -P 2 clang-tidy -p "$build" --quiet 2>"$build/clang-tidy.stderr" ||
    { grep -v 'warnings generated' "$build/clang-tidy.stderr"; exit 1; }
