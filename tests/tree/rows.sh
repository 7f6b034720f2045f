#!/usr/bin/env bash
# Checks that every row of an option table gets the offset of its field from the macros of
# lib/option/rows.h, which check the field's C type at compile time: rows.sh SOURCE. If this fails,
# a row sets an offset without this check, and reading a scene may write a value over a field of
# another type.
set -euo pipefail
cd "$1"
if grep -rnE --include='*.[ch]' --exclude=rows.h '\.(offset|count_offset|kind_offset) *= *[^= ]' lib cmd decode tests; then
    echo "a row with an offset of its own; ROW of lib/option/rows.h takes a field, and checks it"
    exit 1
fi
echo "the rows of option tables are checked"
