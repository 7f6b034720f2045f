#!/usr/bin/env bash
# Builds a target with the address and undefined-behaviour sanitizers, in a build folder of its own:
# sanitize.sh SOURCE BUILD TARGET. The build has one level of vectors, since code for vectors takes long
# to compile.
set -euo pipefail
# Code is compiled by -O1, in half the time of -O2. -Werror is off, since GCC warns of values that may be unset
# where it optimises less.
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO='-O1 -g1' -DKILN_SANITIZE=ON -DKILN_WERROR=OFF \
    -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=native >/dev/null
exec cmake --build "$2" -j 2 --target "$3"
