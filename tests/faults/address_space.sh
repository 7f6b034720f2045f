#!/usr/bin/env bash
# Checks how a job ends that has too little address space (RLIMIT_AS): address_space.sh KILN SCENE
# JOB TRIES. If this fails, kiln crashes or leaves broken files when memory is short. The job must
# end with exit code 5, or with 6 where a library hides that memory was the reason, and with a
# message. No signal may end it, and it may leave no half-written file. With enough address space it
# must end with all its files. The limits are spread evenly, from the least with which the program
# starts, below which the dynamic loader fails, to the least with which the job succeeds.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "address space $job"
choose_job "$job" --fps 1 --set simulation.rate=5 --set output.frames=4 --set 'output.size=[192, 108]'
draw_calm

enough=2048 # MiB with which each job succeeds

# least PROGRAM...: prints the least MiB of address space with which a command succeeds.
least() {
    local low=1 high=$enough middle
    while ((low < high)); do
        middle=$(((low + high) / 2))
        if (cd "$work" && rm -rf least && cp -a before least && cd least &&
            prlimit --as=$((middle << 20)) "$@" >/dev/null 2>&1); then
            high=$middle
        else
            low=$((middle + 1))
        fi
    done
    echo $low
}

first=$(least "$kiln" help exit-codes)

# Just below the limit at which the program starts, there must be a limit at which it cannot get
# memory for a stack, and says so.
said=
for ((limit = (first - 2) << 10; limit < first << 10; limit += 64)); do
    code=0
    message=$(prlimit --as=$((limit << 10)) "$kiln" help exit-codes 2>&1 >/dev/null) || code=$?
    case $code in
    0 | 127) ;; # 127: the dynamic loader fails
    5) [[ $message != 'kiln: out of memory for a stack of '* ]] || said=yes ;;
    *) problem "$limit KiB: exit code $code: $message" ;;
    esac
done
[[ $said ]] || problem "nothing is said of the stack"
settle "a stack"

last=$(($(least "$kiln" "${command[@]}") + 8))
for ((i = 0; i < tries; i++)); do
    limit=$(((first << 10) + (i * ((last - first) << 10) + RANDOM % ((last - first) << 10)) / tries))
    begin tight
    go_on tight timeout 60 prlimit --as=$((limit << 10))
    case $code in
    0) check_all tight ;;
    5 | 6)
        grep -q '^kiln: ' "$work/messages" || problem "it ends with $code and says: $(<"$work/messages")"
        check_wholes tight
        check_tidy tight
        check_end tight
        ;;
    *) problem "exit code $code: $(<"$work/messages")" ;;
    esac
    settle "$limit KiB"
done
