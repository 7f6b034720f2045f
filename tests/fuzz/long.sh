#!/usr/bin/env bash
# libFuzzer on every target, for so many seconds each: long.sh SOURCE BUILD SECONDS. What it finds
# new is kept in BUILD/found; an input that makes a target fail stays in BUILD, and is named.
set -euo pipefail
source=$1 build=$2 seconds=$3
[[ $seconds =~ ^[1-9][0-9]*$ ]] ||
    { echo "KILN_FUZZ_SECONDS: found '$seconds', expected a whole number of seconds" >&2; exit 2; }
probe=$(mktemp -d)
trap 'rm -rf "$probe"' EXIT
echo 'int LLVMFuzzerTestOneInput(const char *d, long n); int LLVMFuzzerTestOneInput(const char *d, long n) { return d && n < 0; }' >"$probe/probe.c"
if ! clang -fsanitize=fuzzer,address "$probe/probe.c" -o "$probe/probe" 2>/dev/null; then
    echo "fuzz_long needs clang and libFuzzer: tools/setup fuzz" >&2
    exit 1
fi
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DKILN_FUZZ=ON -DKILN_SANITIZE=ON -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=0 >/dev/null
cmake --build "$build" --target fuzzers

export LSAN_OPTIONS=print_suppressions=0:suppressions=$source/tests/tree/leaks.supp
export ASAN_OPTIONS=allocator_may_return_null=1
failed=()
for program in "$build"/tests/fuzz/fuzz_*; do
    [[ -f $program && -x $program ]] || continue
    name=${program##*/fuzz_}
    found=$build/found/$name
    mkdir -p "$found"
    echo "$name: $seconds s"
    "$program" -max_total_time="$seconds" -print_final_stats=1 -verbosity=0 -timeout=30 \
        -artifact_prefix="$build/$name-" "$found" "$source/tests/fuzz/corpus/$name"/* ||
        failed+=("$name")
done
if ((${#failed[@]} > 0)); then
    echo "failed: ${failed[*]}" >&2
    exit 1
fi
echo "every target held for $seconds s"
