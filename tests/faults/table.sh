#!/usr/bin/env bash
# Runs the tests of faults of a CTest configuration (faults or soak), two at a time, and prints a
# table of how many faults each test has tried and survived: table.sh CTEST BUILD CONFIGURATION.
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
