#!/usr/bin/env bash
# The tests that need no GL, under the address and undefined-behaviour sanitizers:
# sanitize.sh SOURCE BUILD.
set -euo pipefail
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DKILN_SANITIZE=ON >/dev/null
cmake --build "$2" -j 2 --target host_tests
# An absurd size must be refused by kiln, not by the sanitizer.
export ASAN_OPTIONS=allocator_may_return_null=1
export LSAN_OPTIONS=print_suppressions=0:suppressions=$(dirname "$(realpath "$0")")/leaks.supp
exec ctest --test-dir "$2" -j 2 --output-on-failure -L '^(unit|fuzz)$'
