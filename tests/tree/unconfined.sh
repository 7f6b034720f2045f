#!/usr/bin/env bash
# A program that clang builds with a sanitizer confines nothing (KILN_UNCONFINED in base/confine.h):
# unconfined.sh SOURCE. Skipped (77) without clang.
set -euo pipefail
command -v clang >/dev/null || exit 77
for sanitizer in none address thread memory; do
    flag=() expected=0
    if [ "$sanitizer" != none ]; then
        flag=("-fsanitize=$sanitizer") expected=1
    fi
    printf '#include "base/confine.h"\n_Static_assert(KILN_UNCONFINED == %d, "");\n' "$expected" |
        clang "${flag[@]}" -I"$1/lib" -I"$1/shaders" -fsyntax-only -x c - ||
        { echo "with sanitizer $sanitizer, KILN_UNCONFINED is not $expected" >&2; exit 1; }
done
