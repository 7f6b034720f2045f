#!/usr/bin/env bash
# Checks that no code that computes states or pixels calls a function of the C library that may
# round differently on another machine, such as sin or pow: mathematics.sh SOURCE BUILD. If this
# fails, the same scene may give other pixels on another machine. The operators + - * /, square
# roots and floor are the same on every machine; for other functions, shaders/shared/exact.h has its
# own.
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

# A header can also bring in arithmetic that differs between machines without any of these symbols.
# tgmath.h and complex.h may not be included at all. cglm's code for vector instructions rounds
# differently from its plain C code; only lib/base/matrix.h, which chooses the plain C code, may
# include it.
if grep -rnE '#[ \t]*include[ \t]*["<](tgmath|complex|cglm)' "$source/lib" "$source/shaders" |
    grep -vE "^$source/lib/base/matrix\.h:[0-9]+:#include <cglm/"; then
    failed=1
fi
exit $failed
