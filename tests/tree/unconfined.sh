#!/usr/bin/env bash
# Checks that the macro KILN_UNCONFINED of base/confine.h, which turns sandboxing off, is 1 exactly
# when clang builds with a sanitizer: unconfined.sh SOURCE. If this fails, a kiln-decode with a
# sanitizer is killed for the sanitizer's system calls, or an ordinary kiln-decode decodes untrusted
# files without a sandbox. Without clang the test is skipped (77).
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
