#!/usr/bin/env bash
# Every C file, and what C and GLSL share, as .clang-format has it.
set -euo pipefail
cd "$1"
find lib cmd decode examples tests shaders/shared -not -path '*/node_modules/*' \( -name '*.[ch]' -o -name '*.cc' \) -print0 |
    xargs -0 -n 16 -P 2 clang-format --dry-run -Werror
