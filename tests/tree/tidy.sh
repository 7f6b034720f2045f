#!/usr/bin/env bash
# clang-tidy over every C file, and the headers with them: tidy.sh SOURCE BUILD [OPTION...]. What is
# checked, and what is not and why, is in .clang-tidy. The analyzer takes nine tenths of its time:
# the test leaves it out (--checks=-clang-analyzer-*), `--target analyze` runs all.
set -uo pipefail
cd "$1" || exit
build=$2
shift 2
# Notes on "N warnings suppressed" go to stderr; findings, and what does not compile, to stdout.
find lib cmd tests -name '*.c' -not -path '*/node_modules/*' -print0 | sort -z |
    xargs -0 -n 4 -P 2 clang-tidy -p "$build" --quiet "$@" 2>"$build/clang-tidy.stderr" ||
    { grep -v 'warnings generated' "$build/clang-tidy.stderr"; exit 1; }
