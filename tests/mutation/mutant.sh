#!/usr/bin/env bash
# Writes a C file with a deliberate fault, which a sed expression makes: mutant.sh SOURCE EXPRESSION
# OUT. An expression that changes nothing is an error, since no test could see its fault.
set -euo pipefail
sed "$2" "$1" >"$3"
if cmp -s "$1" "$3"; then
    rm "$3"
    echo "the expression '$2' changes nothing in $1" >&2
    exit 1
fi
