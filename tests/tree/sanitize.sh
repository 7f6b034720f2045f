#!/usr/bin/env bash
# Builds targets with the address and undefined-behaviour sanitizers, in a build folder of its own:
# sanitize.sh SOURCE BUILD TARGET... If this fails, the tests sanitize.NAME have no programs to run.
# The build has only the machine's widest SIMD level, since code for SIMD takes long to compile.
set -euo pipefail
# With -O1 the code compiles in half the time of -O2. -Werror is off, since GCC optimises less and then warns of
# variables that may be uninitialised.
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO='-O1 -g1' -DKILN_SANITIZE=ON -DKILN_WERROR=OFF \
    -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=native >/dev/null
exec cmake --build "$2" -j 2 --target "${@:3}"
