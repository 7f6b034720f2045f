#!/usr/bin/env bash
# Checks how a job ends when one of kiln's own allocations fails, or all from some call on:
# starved.sh KILN_STARVED SCENE JOB TRIES. If this fails, kiln crashes, hangs or leaves broken files
# when memory is short. The job must end with exit code 5 and a message, or with all its files where
# it can do without the memory. No sanitizer or signal may end it, and it may leave no half-written
# file. KILN_STARVED is kiln linked with starve.c. The TRIES calls that fail are spread evenly over
# all calls; with TRIES 0, each call fails in its turn.
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

# starve WHICH: runs the job with KILN_STARVE=WHICH, a call ("40") or all from a call on ("40+").
starve() {
    begin starved
    KILN_STARVE=$1 go_on starved timeout 60
    case $code in
    0)
        check_all starved
        # The result of `check` is its output. `plan` prints measured times, which differ.
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
