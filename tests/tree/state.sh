#!/usr/bin/env bash
# Checks that the library has no writable variable at file scope, except those listed below:
# state.sh SOURCE LIBRARY. If this fails, two renderers in one process may disturb each other.
set -euo pipefail
library=$2

# The exceptions, each as "object symbol":
allowed=(
    # The names of unfinished files. A signal handler removes these files, and it gets no pointer by
    # which it could find the names elsewhere.
    "temporary.c.o slots"
    "temporary.c.o ending"
    # The receiver of FFmpeg's messages, one per thread. FFmpeg's log callback gets no user pointer.
    "ffmpeg.c.o current"
    # FFmpeg's libraries, which are opened once a process, and pointers to their functions.
    "ffmpeg.c.o libraries"
    "ffmpeg.c.o mutex.0"
    "ffmpeg.c.o kiln_ff"
    # libdeflate, which is opened once a process.
    "libdeflate.c.o library"
    "libdeflate.c.o is_open.1"
    "libdeflate.c.o mutex.2"
)

# A symbol is writable if its section is .data, .bss, .tdata, .tbss or *COM*. .data.rel.ro is not:
# it holds tables of pointers, which are constant after the dynamic linker has relocated them.
failed=0
while read -r object symbol; do
    for entry in "${allowed[@]}"; do
        [[ $entry == "$object $symbol" ]] && continue 2
    done
    echo "$object: '$symbol' is mutable state at file scope"
    failed=1
done < <(objdump -t "$library" | awk '
    /^[^ ]+\.o:/ { object = $1; sub(/:.*/, "", object); next }
    {
        section = ""
        for (i = 1; i < NF; i++) if ($i ~ /^\.(t?data|t?bss)|^\*COM\*$/) section = $i
        if (section != "" && section != $NF && section !~ /^\.data\.rel\.ro/) print object, $NF
    }')
exit $failed
