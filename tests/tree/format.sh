#!/usr/bin/env bash
# Checks that every C and C++ file, and every header that C and GLSL share, is formatted as
# .clang-format says: format.sh SOURCE. If this fails, diffs mix changes of format with changes of
# code.
set -euo pipefail
cd "$1"
find lib cmd decode examples tests shaders/shared -not -path '*/node_modules/*' \( -name '*.[ch]' -o -name '*.cc' \) -print0 |
    xargs -0 -n 16 -P 2 clang-format --dry-run -Werror
