#!/usr/bin/env bash
# Checks that the rows of option tables take their offsets from the macros of lib/option/rows.h, which
# compare the C type of the field: rows.sh SOURCE. If this fails, a row has an offset of its own, and
# a value may be written over a field of another type.
set -euo pipefail
cd "$1"
if grep -rnE --include='*.[ch]' --exclude=rows.h '\.(offset|count_offset|kind_offset) *= *[^= ]' lib cmd decode tests; then
    echo "a row with an offset of its own; ROW of lib/option/rows.h takes a field, and checks it"
    exit 1
fi
echo "the rows of option tables are checked"
