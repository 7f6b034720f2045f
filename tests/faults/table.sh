#!/usr/bin/env bash
# table.sh CTEST BUILD CONFIGURATION: runs the tests of a configuration, two at a time, and prints what was
# tried and survived.
set -uo pipefail
KILN_FAULT_ROWS=$(mktemp -d)
export KILN_FAULT_ROWS
trap 'rm -rf "$KILN_FAULT_ROWS"' EXIT
begun=$SECONDS
"$1" --test-dir "$2" -C "$3" -L "^$3_all\$" -j 2 --output-on-failure
code=$?
echo
cat "$KILN_FAULT_ROWS"/*
echo "$((SECONDS - begun)) seconds"
exit $code
