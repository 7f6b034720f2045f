#!/usr/bin/env bash
# Checks that the library has no writable global or static variable, except those listed below:
# state.sh SOURCE LIBRARY. If this fails, two renderers in one process may disturb each other.
set -euo pipefail
library=$2

# The allowed variables, each as "object-file symbol":
allowed=(
    # The names of unfinished files, which a signal handler removes. They are global since a signal
    # handler gets no pointer to data of the program.
    "temporary.c.o slots"
    "temporary.c.o ending"
    # Where each thread receives FFmpeg's messages. It is a variable of the thread since FFmpeg's
    # log callback gets no user pointer.
    "ffmpeg.c.o current"
    # Handles of FFmpeg's libraries, which a process opens once, and pointers to their functions.
    "ffmpeg.c.o libraries"
    "ffmpeg.c.o mutex.0"
    "ffmpeg.c.o kiln_ff"
    # The locale C, which never changes, and which FFmpeg's functions run in.
    "ffmpeg.c.o c_locale"
    # The handle of libdeflate, which a process opens once.
    "libdeflate.c.o library"
    "libdeflate.c.o is_open.1"
    "libdeflate.c.o mutex.2"
)

# A variable is writable if its section is .data, .bss, .tdata, .tbss or *COM*. Section .data.rel.ro
# is not writable: the dynamic linker relocates its tables of pointers, and then makes it read-only.
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
