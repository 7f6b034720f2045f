#!/bin/bash
# Checks that kiln is linked with at most 10 shared libraries, including those that its libraries
# need: start.sh PROGRAM. If this fails, every start of kiln becomes slower. Libraries that only
# some runs need are not linked but loaded by these runs (lib/base/library.h).
set -euo pipefail
program=$1
most=10
mapfile -t libraries < <(LD_TRACE_LOADED_OBJECTS=1 "$program" | awk '/=>/ { print $1 }')
printf '%s\n' "${libraries[@]}"
((${#libraries[@]} > 1)) || { echo "the program's libraries cannot be listed"; exit 1; }
((${#libraries[@]} <= most)) || { echo "${#libraries[@]} libraries are opened; allowed are $most"; exit 1; }
