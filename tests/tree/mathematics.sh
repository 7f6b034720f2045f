#!/usr/bin/env bash
# The same pixels on every machine: mathematics.sh SOURCE BUILD. Where states and pixels are computed,
# nothing of the C library is called that may round differently from one to another; + - * /, square
# roots, floor and the like are exact, and shaders/shared/exact.h has the rest.
set -euo pipefail
source=$1 build=$2

rooms=(asset draw option output particles post scene sim sort)
functions='a?(sin|cos|tan)h?|sincos|atan2|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot'
functions+='|erfc?|[lt]gamma|fma|fmod|remainder|dot|c(abs|arg|exp|log|pow|sqrt)'

objects=()
for room in "${rooms[@]}"; do
    found=$(find "$build"/CMakeFiles/kiln*.dir/lib/"$room" -name '*.o')
    if [[ -z $found ]]; then
        echo "no object of lib/$room under $build"
        exit 2
    fi
    mapfile -t -O "${#objects[@]}" objects <<<"$found"
done

failed=0
while read -r object symbol; do
    echo "${object#"$build"/CMakeFiles/} calls '$symbol', which is not the same everywhere"
    failed=1
done < <(nm --undefined-only --print-file-name "${objects[@]}" |
    sed -nE "s/^([^:]+):.* U ($functions)[fl]?(@.*)?\$/\1 \2/p")

# What a header brings along need not be called by name. cglm's vector paths round in another way than
# its plain C, which lib/base/matrix.h takes; no other file may include it.
if grep -rnE '#[ \t]*include[ \t]*["<](tgmath|complex|cglm)' "$source/lib" "$source/shaders" |
    grep -vE "^$source/lib/base/matrix\.h:[0-9]+:#include <cglm/"; then
    failed=1
fi
exit $failed
