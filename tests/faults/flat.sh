#!/usr/bin/env bash
# Checks that a long job needs no more memory and open files at its end than near its beginning:
# flat.sh KILN SCENE JOB FRAMES. If this fails, kiln leaks memory or descriptors, and a job of hours
# runs out of them. Resident memory and open descriptors are sampled all the time, from the first
# finished file on. The mean of the last tenth of the samples may exceed the mean of the second
# tenth by 5 % of the memory plus 1 MiB, and by two descriptors, since the threads that encode open
# and close files all the time.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 frames=$4
start "flat memory $job"
choose_job "$job" --fps 10 --set "output.frames=$frames" --set 'output.size=[32, 18]' \
    --set systems.fire.emit.rate=60
begin long
mkdir "$work/long/out"

(cd "$work/long" && exec "$kiln" "${command[@]}" >"$work/output" 2>"$work/messages") &
process=$!
until compgen -G "$work/long/out/f_*[0-9].???" >/dev/null || compgen -G "$work/long/out/*.parts/*.part" >/dev/null; do
    kill -0 $process 2>/dev/null || break
done
while [[ -e /proc/$process/fd ]]; do
    descriptors=(/proc/$process/fd/*)
    memory=$(awk '/^VmRSS/ { print $2 }' /proc/$process/status 2>/dev/null) || break
    [[ -n $memory ]] || break
    echo "$memory ${#descriptors[@]}"
done >"$work/samples"
code=0
wait $process || code=$?
((code == 0)) || problem "exit code $code: $(<"$work/messages")"

# mean FIRST LAST COLUMN: prints 1000 times the mean of a column of the samples, from FIRST tenths
# of the samples to LAST tenths.
mean() {
    awk -v first="$1" -v last="$2" -v column="$3" '{ values[NR] = $column }
        END {
            for (i = int(NR * first / 10) + 1; i <= int(NR * last / 10); i++) { sum += values[i]; count++ }
            printf "%d", sum / (count ? count : 1) * 1000
        }' "$work/samples"
}

(($(wc -l <"$work/samples") >= 20)) || problem "only $(wc -l <"$work/samples") samples"
kib=$(mean 1 2 1) last_kib=$(mean 9 10 1) files=$(mean 1 2 2) last_files=$(mean 9 10 2)
echo "resident KiB $((kib / 1000)), then $((last_kib / 1000)); descriptors $((files / 1000)), then $((last_files / 1000))"
((last_kib <= kib + kib / 20 + 1024000)) || problem "memory grows from $((kib / 1000)) to $((last_kib / 1000)) KiB"
((last_files <= files + 2000)) || problem "descriptors grow from $((files / 1000)) to $((last_files / 1000))"
settle "$frames frames"
