#!/usr/bin/env bash
# Runs libFuzzer on every fuzz target: long.sh SOURCE BUILD SECONDS. If this fails, some input
# crashes a parser or decoder of kiln. All targets together get SECONDS of processor time, shared
# evenly, in turns of a minute of real time. BUILD/found/NAME.spent records the processor time that
# the target NAME has had, in seconds. So a run that was stopped goes on with the time that is left,
# and a run on a busy machine or under `nice` takes longer but tests as much. Inputs that reach new
# code are kept in BUILD/found/NAME. An input that makes a target fail stays in BUILD/NAME-crash-*,
# and the log names it. At the end, coverage.sh prints how many lines of kiln's parsers the inputs
# reach.
set -euo pipefail
source=$1 build=$2 seconds=$3
[[ $seconds =~ ^[1-9][0-9]*$ ]] ||
    { echo "KILN_FUZZ_SECONDS: found '$seconds', expected a whole number of seconds" >&2; exit 2; }
probe=$(mktemp -d)
trap 'rm -rf "$probe"' EXIT
echo 'int LLVMFuzzerTestOneInput(const char *d, long n); int LLVMFuzzerTestOneInput(const char *d, long n) { return d && n < 0; }' >"$probe/probe.c"
if ! clang -fsanitize=fuzzer,address "$probe/probe.c" -o "$probe/probe" 2>/dev/null; then
    echo "fuzz-long needs clang and libFuzzer: tools/setup fuzz" >&2
    exit 1
fi
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DKILN_FUZZ=ON -DKILN_SANITIZE=ON -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=plain >/dev/null
cmake --build "$build" --target fuzzers

export LSAN_OPTIONS=print_suppressions=0:suppressions=$source/tests/tree/leaks.supp
export ASAN_OPTIONS=allocator_may_return_null=1
export source build turn=60
mapfile -t names < <(find "$build/tests/fuzz" -maxdepth 1 -name 'fuzz_*' -type f -executable -printf '%f\n' |
    sed 's/^fuzz_//' | sort)
export share=$(((seconds + ${#names[@]} - 1) / ${#names[@]}))

# is_slow NAME: succeeds if the failure of a target is real. libFuzzer's timeout counts real time,
# so on a busy machine a fast input can exceed it. An input that timed out is therefore run again
# with a limit of 30 s of processor time. If that run succeeds, the failure is not real, and the
# input is removed.
is_slow() {
    local name=$1 input
    input=$(sed -n 's/.*Test unit written to //p' "$build/found/$name.log" | tail -n 1)
    grep -q 'libFuzzer: timeout' "$build/found/$name.log" && [[ -f $input ]] || return 0
    ! (ulimit -t 30 && "$build/tests/fuzz/fuzz_$name" -timeout=0 "$input" >/dev/null 2>&1) || { rm "$input"; false; }
}

# fuzz NAME: runs a target for one turn. The target `import` has the seeds of `mesh`.
fuzz() {
    local name=$1 found=$build/found/$1 spent=0 left corpus
    corpus=$source/tests/fuzz/corpus/${name/import/mesh}
    mkdir -p "$found"
    [[ ! -s $found.spent ]] || read -r spent <"$found.spent"
    left=$((share - spent < turn ? share - spent : turn))
    ((left > 0)) || return 0
    local TIMEFORMAT='%U %S' times
    if ! times=$({ time "$build/tests/fuzz/fuzz_$name" -max_total_time=$left -print_final_stats=1 -timeout=30 \
        -rss_limit_mb=4096 -artifact_prefix="$build/$name-" "$found" "$corpus"/* \
        >"$found.log" 2>&1; } 2>&1) && is_slow "$name"; then
        echo "$name: failed after $spent s: $(grep -m1 -E 'ERROR|SUMMARY|fuzz:' "$found.log")"
        return 1
    fi
    spent=$(awk -v had="$spent" '{ print had + int($1 + $2) + 1 }' <<<"$times")
    echo "$spent" >"$found.spent"
    printf '%-10s %6d s %8d inputs kept, %s\n' "$name" "$spent" "$(find "$found" -type f | wc -l)" \
        "$(grep -oE 'cov: [0-9]+' "$found.log" | tail -n 1)"
}
export -f fuzz is_slow

# left: prints the targets that have not yet used their share of processor time.
left() {
    local name spent
    for name in "${names[@]}"; do
        spent=0
        [[ ! -s $build/found/$name.spent ]] || read -r spent <"$build/found/$name.spent"
        ((spent >= share)) || echo "$name"
    done
}

status=0
while unfinished=$(left) && [[ -n $unfinished ]] && ((status == 0)); do
    xargs -P "$(nproc)" -I{} bash -c 'fuzz {}' <<<"$unfinished" || status=1
done
"$source/tests/fuzz/coverage.sh" "$source" "$build-coverage" "$build/found"
((status == 0)) && echo "every target held for $share s"
exit $status
