#!/usr/bin/env bash
# Checks that each installed header compiles alone as C11, C17, C++17 and C++20, without a warning
# of a strict set: headers.sh SOURCE CC CXX. If this fails, a user's program that makes warnings
# errors does not compile. It also checks that no struct of parameters is filled by a function
# *_empty: a caller would take its zeros for the defaults.
set -euo pipefail
source=$1 cc=$2 cxx=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
common=(-fsyntax-only -Werror -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-qual
    -Wcast-align -Wundef -Wdouble-promotion -Wformat=2 -I "$source/lib")
for header in kiln kiln_compare kiln_job kiln_limits kiln_sandbox; do
    printf '#include <%s.h>\nstruct kiln_error use(void);\nstruct kiln_error use(void) { return kiln_error_empty(); }\n' \
        "$header" >"$folder/use.c"
    cp "$folder/use.c" "$folder/use.cc"
    for standard in c11 c17; do
        "$cc" -std=$standard -Wstrict-prototypes -Wmissing-prototypes "${common[@]}" "$folder/use.c"
    done
    for standard in c++17 c++20; do
        "$cxx" -std=$standard -Wold-style-cast -Wzero-as-null-pointer-constant -Wnon-virtual-dtor \
            "${common[@]}" "$folder/use.cc"
    done
done
if grep -HnE '_params_empty\b|KILN_EMPTY\(\w+_params, \w+_empty\)' "$source"/lib/kiln*.h; then
    echo "parameters are filled by a function *_defaults alone"
    exit 1
fi
echo "five headers, four languages"
