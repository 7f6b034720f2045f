#!/bin/bash
# start.sh PROGRAM: a start of kiln opens few libraries. Those that only some runs need are opened by
# them (lib/base/library.h), and what a library of ours brings along counts, too.
set -euo pipefail
program=$1
most=10
mapfile -t libraries < <(LD_TRACE_LOADED_OBJECTS=1 "$program" | awk '/=>/ { print $1 }')
printf '%s\n' "${libraries[@]}"
((${#libraries[@]} > 1)) || { echo "the program's libraries cannot be listed"; exit 1; }
((${#libraries[@]} <= most)) || { echo "${#libraries[@]} libraries are opened; allowed are $most"; exit 1; }
