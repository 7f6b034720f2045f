#!/usr/bin/env bash
# Checks how a job ends whose files are removed while it runs: vanish.sh KILN SCENE JOB TRIES. If
# this fails, kiln crashes or trusts files that are gone. Each try removes, at a random time, the
# job's folder, the folder of its parts or its journal. The job must end with exit code 6 and a
# message, or with all files if it did not need the removed ones any more. It may leave no
# half-written file. Resumed, it must end with the bytes of an undisturbed run. Without its journal,
# kiln cannot know to which job the files belong; then --force is needed, too.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "vanish $job"
choose_job "$job" --fps 10 --set output.frames=61
draw_calm
of_job=("${anew[@]}")

# stop PROCESS: suspends the process, so that its files do not change between a check of them and
# their removal. Fails when the process has ended.
stop() {
    local state
    while kill -STOP "$1" 2>/dev/null; do
        { read -r _ _ state _ <"/proc/$1/stat"; } 2>/dev/null || return 1
        [[ $state != T ]] || return 0
        [[ $state != Z ]] || return 1
    done
    return 1
}

# is_over: succeeds if the job has finished all its files. To remove one then would test nothing.
is_over() {
    [[ $(results "$work/calm") == "$(results "$work/gone")" ]] &&
        [[ ! -e $work/calm/out/m.json || -e $work/gone/out/m.json ]]
}

while ((tried < tries)); do
    begin gone
    (cd "$work/gone" && exec "$kiln" "${command[@]}" >"$work/output" 2>"$work/messages") &
    process=$!
    sleep "$(seconds $((RANDOM % calm_ms)))"
    targets=("$work"/gone/out "$work"/gone/out/*.parts "$work"/gone/out/*.journal)
    target=${targets[RANDOM % ${#targets[@]}]}
    if ! stop $process || [[ ! -e $target ]] || is_over; then
        kill -KILL $process 2>/dev/null || true
        wait $process 2>/dev/null || true
        continue
    fi
    rm -rf "$target"
    kill -CONT $process
    code=0
    wait $process || code=$?
    case $code in
    0) check_all gone ;;
    6) grep -q '^kiln: ' "$work/messages" || problem "it ends with 6 and says: $(<"$work/messages")" ;;
    *) problem "exit code $code: $(<"$work/messages")" ;;
    esac
    check_wholes gone
    check_tidy gone
    if [[ $job == join ]]; then
        begin gone # the shards have to be drawn again before they can be joined
    elif [[ ${command[0]} == render && $target != *.parts ]]; then # the journal is gone
        anew=(--force)
    fi
    check_end gone
    anew=("${of_job[@]}")
    settle "${target##*/} gone"
done
