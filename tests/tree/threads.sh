#!/usr/bin/env bash
# Builds kiln's tests of threads with the thread sanitizer, in a build folder of their own, and runs
# them: threads.sh SOURCE BUILD CC. If this fails, two threads use the same memory without
# synchronisation.
set -euo pipefail
source=$1 build=$2 cc=$3
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_C_COMPILER="$cc" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS=-fsanitize=thread -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=plain >/dev/null
cmake --build "$build" --target unit_threads unit_stopping
for program in unit_threads unit_stopping; do
    (cd "$build/tests" && TSAN_OPTIONS=halt_on_error=1 "./$program")
done
