#!/usr/bin/env bash
# Prints how many lines of each parser the inputs of the fuzz targets reach, counted by gcov:
# coverage.sh SOURCE BUILD [FOUND]. The inputs are the files of corpus/ and the inputs that
# libFuzzer has found and the build target fuzz-long has kept in FOUND. A line that no input reaches
# is not fuzzed.
set -euo pipefail
source=$1 build=$2 found=${3:-}
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_C_COMPILER=gcc -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_C_FLAGS="--coverage -fprofile-update=atomic" -DKILN_TESTS=ON -DKILN_SIMD_LEVELS=plain >/dev/null
cmake --build "$build" --target replays >/dev/null
mapfile -t names < <(find "$build/tests/fuzz" -maxdepth 1 -name 'replay_*' -type f -executable -printf '%f\n' |
    sed 's/^replay_//' | sort)
find "$build" -name '*.gcda' -delete
for name in "${names[@]}"; do
    folders=("$source/tests/fuzz/corpus/$name"/*)
    [[ ! -d $found/$name ]] || folders+=("$found/$name")
    "$build/tests/fuzz/replay_$name" 0 "${folders[@]}" >/dev/null || echo "$name fails on a kept input" >&2
done
files=(decode/{png,picture,video,exr,avframe} lib/asset/image/{image,received,video_in}
    lib/asset/loader/{helper,loader} lib/asset/geometry/{mesh_in,mesh_arrays,skin,grid_in} lib/option/{node,reader}
    lib/suite/{test_file,expect,result_read} lib/figure/record lib/job/{journal_read,journal_head,state,state_check,pack}
    lib/output/part_file)
printf '%-36s %8s %8s\n' file lines reached
for file in "${files[@]}"; do
    data=$(find "$build" -path "*$file.c.gcda" | head -n 1)
    [[ -n $data ]] || continue
    gcov -n "$data" 2>/dev/null | awk -v file="$file.c" '
        /^File/ { own = index($0, file) > 0 }
        own && /^Lines executed/ {
            split($0, p, /[:% ]+/)
            printf "%-36s %8d %7.1f%%\n", file, $NF, p[3]
            own = 0
        }'
done
