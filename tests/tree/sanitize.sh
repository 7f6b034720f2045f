#!/usr/bin/env bash
# The tests that need no GL, under the address and undefined-behaviour sanitizers:
# sanitize.sh SOURCE BUILD.
set -euo pipefail
# One width of vectors: the generic ones take most of the time, to compile and to run.
level=0
! grep -qw avx2 /proc/cpuinfo || level=2
# -O1 is compiled in half the time. Warnings there are of what a compiler cannot know then.
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO='-O1 -g1' -DKILN_SANITIZE=ON -DKILN_WERROR=OFF \
    -DKILN_SIMD_LEVELS=$level >/dev/null
cmake --build "$2" -j 2 --target host_tests
# An absurd size must be refused by kiln, not by the sanitizer.
export ASAN_OPTIONS=allocator_may_return_null=1
export LSAN_OPTIONS=print_suppressions=0:suppressions=$(dirname "$(realpath "$0")")/leaks.supp
exec ctest --test-dir "$2" -j 2 --output-on-failure -L '^(unit|fuzz)$'
