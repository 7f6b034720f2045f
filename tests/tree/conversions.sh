#!/usr/bin/env bash
# Checks that lib/draw and lib/post convert no float to an integer themselves: conversions.sh SOURCE BUILD. They call
# exact_int and exact_uint (shaders/shared/exact.h), which have a result for every float. If this fails, a position of
# 1e30 m or a NaN is a conversion that C leaves undefined: a picture may differ between machines, and a build with
# sanitizers aborts.
#
# No warning of a compiler finds these conversions, since most are casts, and a pattern for (int) would also find the
# casts of integers. So clang compiles each file to its intermediate language, in which the conversion of a single
# float is the instruction fptosi or fptoui. Those of vectors are left out: on x86 they have a result for every
# float, and base/lanes.h gives the same one elsewhere. A file that the build compiles by several commands is
# checked with the first. Headers of other folders are not checked; those of shaders/shared convert what their
# formulas have limited.
set -euo pipefail
source=$(realpath "$1") build=$2

# conversions COMMAND: prints "FILE:LINE" of each conversion in what a command of the build compiles. The numbers
# behind "!" in clang's output stand for places, functions and files.
conversions() {
    local -a words arguments=()
    eval "words=($1)"
    for ((i = 1; i < ${#words[@]}; i++)); do
        case ${words[i]} in
        -o) i=$((i + 1)) ;;
        -I | -isystem | -include) arguments+=("${words[i]}" "${words[i + 1]}") && i=$((i + 1)) ;;
        -[IDUm]* | -std=*) arguments+=("${words[i]}") ;;
        -*) ;;
        *) arguments+=("${words[i]}") ;;
        esac
    done
    clang "${arguments[@]}" -w -O0 -gline-tables-only -S -emit-llvm -Xclang -disable-llvm-passes -o - | awk '
        match($0, /fpto[su]i (float|double|x86_fp80|half) .*!dbg ![0-9]+/) {
            sub(/.*!dbg /, ""); sub(/[^!0-9].*/, ""); places[$0]; next
        }
        /^![0-9]+ = / {
            line = scope = file = name = ""
            if (match($0, /line: [0-9]+/)) line = substr($0, RSTART + 6, RLENGTH - 6)
            if (match($0, /scope: ![0-9]+/)) scope = substr($0, RSTART + 7, RLENGTH - 7)
            if (match($0, /file: ![0-9]+/)) file = substr($0, RSTART + 6, RLENGTH - 6)
            if (match($0, /filename: "[^"]*"/)) name = substr($0, RSTART + 11, RLENGTH - 12)
            lines[$1] = line; scopes[$1] = scope; files[$1] = file; names[$1] = name
        }
        END {
            for (place in places) {
                for (scope = scopes[place]; scope in scopes && files[scope] == ""; scope = scopes[scope]);
                print names[files[scope]] ":" lines[place]
            }
        }'
}
export -f conversions

# clang names files below the working directory by their path from there.
cd "$source"
found=$(jq -r '[.[] | select(.file | test("/lib/(draw|post)/"))] | unique_by(.file)[].command' \
    "$build/compile_commands.json" |
    xargs -d '\n' -n 1 -P "$(nproc)" bash -o pipefail -c 'conversions "$1"' conversions)
[[ -n $found ]] || { echo "no conversion at all is found, not even that of shaders/shared/exact.h"; exit 2; }
sort -u -t : -k 1,1 -k 2,2n <<<"$found" | awk '
    /^lib\/(draw|post)\// {
        print $0 ": a float is cast to an integer; exact_int and exact_uint of shared/exact.h convert every float"
        failed = 1
    }
    END { exit failed }'
