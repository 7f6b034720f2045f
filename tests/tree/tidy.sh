#!/usr/bin/env bash
# Runs clang-tidy over C files and the headers that they include: tidy.sh SOURCE BUILD [OPTION...] [PART/COUNT |
# -- FILE...]. If this fails, a file breaks a rule of .clang-tidy or has a warning of clang, often a sign of a bug.
# Without FILE, all C files are checked. A file that BUILD compiles by several commands, such as a file *_simd.c,
# is checked with each command. OPTION is an option of clang-tidy: tests give --checks=-clang-analyzer-*, since
# the analyzer takes nine tenths of the time; the build target `analyze` runs all checks. PART/COUNT checks a part
# of the files in one process: "2/3" every third file, from the second on.
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
# clang-tidy prints findings and errors of the compiler to stdout. Its stderr has notes such as "N warnings
# suppressed", which are shown only if it fails.
printf '%s\n' "${files[@]}" |
    xargs -d '\n' -n 4 -P "$processes" clang-tidy -p "$build" --quiet "${options[@]}" 2>"$notes" ||
    { grep -v 'warnings generated' "$notes"; exit 1; }
