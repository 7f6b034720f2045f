#!/usr/bin/env bash
# clang-tidy over C files, and the headers with them:
# tidy.sh SOURCE BUILD [OPTION...] [PART/COUNT | -- FILE...]. A file is checked with each command of
# the build that compiles it, and clang's own warnings count, too. What is checked, and what is not
# and why, is in .clang-tidy. The analyzer takes nine tenths of the time: the tests leave it out
# (--checks=-clang-analyzer-*), `--target analyze` runs all. With "2/3" every third file is looked
# at, from the second, by one process.
set -uo pipefail
cd "$1" || exit
build=$2
shift 2
part=1 count=1 processes=$(nproc)
options=() files=()
while (($# > 0)); do
    if [[ $1 == -- ]]; then
        files=("${@:2}")
        break
    elif [[ $1 =~ ^([1-9][0-9]*)/([1-9][0-9]*)$ ]]; then
        part=${BASH_REMATCH[1]} count=${BASH_REMATCH[2]} processes=1
    else
        options+=("$1")
    fi
    shift
done
if ((${#files[@]} == 0)); then
    mapfile -t files < <(find lib cmd decode tests -name '*.c' -not -path '*/node_modules/*' | sort |
        awk -v part="$part" -v count="$count" 'NR % count == part % count')
fi
notes=$(mktemp)
trap 'rm -f "$notes"' EXIT
# Notes on "N warnings suppressed" go to stderr; findings, and what does not compile, to stdout.
printf '%s\n' "${files[@]}" |
    xargs -d '\n' -n 4 -P "$processes" clang-tidy -p "$build" --quiet "${options[@]}" 2>"$notes" ||
    { grep -v 'warnings generated' "$notes"; exit 1; }
