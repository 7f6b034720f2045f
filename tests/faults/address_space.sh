#!/usr/bin/env bash
# address_space.sh KILN SCENE JOB TRIES: a job with too little address space (RLIMIT_AS) ends with exit
# code 5, or 6 where a library kept its reason to itself, and a message; with enough it ends with all its
# files. No signal ends it, and nothing is left half-written. The limits are spread evenly from where the
# program itself starts, below which the dynamic loader fails, to where the job succeeds.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "address space $job"
choose_job "$job" --fps 1 --set simulation.rate=5 --set output.frames=4 --set 'output.size=[192, 108]'
draw_calm

enough=2048 # MiB, for anything here

# least PROGRAM...: the least MiB of address space with which a command succeeds.
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

# A little below it, the main thread's stack has no memory, which the program says.
said=
for ((limit = (first - 2) << 10; limit < first << 10; limit += 64)); do
    code=0
    message=$(prlimit --as=$((limit << 10)) "$kiln" help exit-codes 2>&1 >/dev/null) || code=$?
    case $code in
    0 | 127) ;; # 127: the dynamic loader fails
    5) [[ $message != 'kiln: no memory for a stack of '* ]] || said=yes ;;
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
