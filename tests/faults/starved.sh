#!/usr/bin/env bash
# starved.sh KILN_STARVED SCENE JOB TRIES: a job that one of kiln's own allocations fails in, and one that
# no more succeed in from some call on, ends with exit code 5 and a message, or with all its files where
# it could do without. No sanitizer or signal ends it, it does not hang, and nothing is half-written. The
# calls that fail are spread evenly over all; with TRIES 0 it is each of them.
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
. "$(dirname "$0")/common.sh"
start "starved $job"
choose_job "$job" --fps 1 --set simulation.rate=5 --set simulation.warmup=0 --set output.frames=4 \
    --set 'output.size=[32, 18]'
export ASAN_OPTIONS=allocator_may_return_null=1
export LSAN_OPTIONS=print_suppressions=0:suppressions=$(dirname "$(dirname "$(realpath "$0")")")/tree/leaks.supp
KILN_STARVE_COUNT=$work/count draw_calm
calls=$(<"$work/count")
((tries > 0 && tries < calls)) || tries=$calls

# starve WHICH: such calls fail.
starve() {
    begin starved
    KILN_STARVE=$1 go_on starved timeout 60
    case $code in
    0)
        check_all starved
        # What these jobs make is what they say; that of a plan are times.
        [[ $job != check ]] || cmp -s "$work/calm.output" "$work/output" || problem "it says something else"
        ;;
    5)
        [[ -s $work/messages ]] || problem "it ends with 5 without a word"
        check_wholes starved
        check_tidy starved
        ;;
    *) problem "exit code $code: $(head -n 20 "$work/messages")" ;;
    esac
    settle "call $1 of $calls"
}

for ((i = 0; i < tries; i++)); do
    call=$((1 + (i * calls + RANDOM % calls) / tries))
    starve $call
    ((i % 4 != 0)) || starve $call+
done
