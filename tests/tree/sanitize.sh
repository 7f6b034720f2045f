#!/usr/bin/env bash
# Builds the tests that need no GL with the address and undefined-behaviour sanitizers:
# sanitize.sh SOURCE BUILD TARGET.
set -euo pipefail
# One width of vectors: the generic ones take most of the time, to compile and to run.
# -O1 is compiled in half the time. Warnings there are of what a compiler cannot know then.
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO='-O1 -g1' -DKILN_SANITIZE=ON -DKILN_WERROR=OFF \
    -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=native >/dev/null
exec cmake --build "$2" -j 2 --target "$3"
