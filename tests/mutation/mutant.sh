#!/usr/bin/env bash
# mutant.sh SOURCE EXPRESSION OUT: a C file with a deliberate fault, made by a sed expression.
set -euo pipefail
sed "$2" "$1" >"$3"
if cmp -s "$1" "$3"; then
    rm "$3"
    echo "the expression '$2' changes nothing in $1" >&2
    exit 1
fi
