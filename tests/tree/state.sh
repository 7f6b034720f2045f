#!/usr/bin/env bash
# No file-scope mutable state in the library: state.sh SOURCE LIBRARY. Two renderers live in one
# process, and a run is saved by saving its structs.
set -euo pipefail
library=$2

# The exceptions, "object symbol":
allowed=(
    # Names of unfinished files: a signal handler has nobody to ask for them.
    "temporary.c.o slots"
    "temporary.c.o ending"
    # FFmpeg's log callback gets no user pointer; one per thread says whose messages these are.
    "ffmpeg.c.o current"
    # A process has FFmpeg's libraries once, and their functions.
    "ffmpeg.c.o libraries"
    "ffmpeg.c.o mutex.0"
    "ffmpeg.c.o kiln_ff"
    # And so it has libdeflate.
    "libdeflate.c.o library"
    "libdeflate.c.o is_open.1"
    "libdeflate.c.o mutex.2"
)

# D, B and C are writable data. libepoxy's dispatch pointers are data of libepoxy, not of kiln.
# .data.rel.ro (tables of pointers, constant once relocated) is also shown as d.
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
