#!/usr/bin/env bash
# kills.sh KILN SCENE JOB KILLS SIGNAL...: a job that is killed at so many random points by each signal
# and gone on with ends with the bytes of one that nobody disturbed. After each kill only whole files
# stand under their names, the exit code is the documented one, and a program that could clean up has
# left nothing half-written.
kiln=$1 scene=$(realpath "$2") job=$3 kills=$4
. "$(dirname "$0")/common.sh"
shift 4
start "kill $job"

# Clips are of six seconds, so that they have several parts. States are large, so that a kill may well
# come while one is being written.
options=(--fps 10 --set output.frames=61)
[[ $job != bake ]] || options+=(--set systems.smoke.emit.rate=8000)
GRID=7x7 choose_job "$job" "${options[@]}"
draw_calm

declare -A codes=([KILL]=137 [TERM]=143 [INT]=130)
for signal in "$@"; do
    begin killed
    for ((kill = 0; kill < kills;)); do
        after=$((RANDOM % (calm_ms + calm_ms / 4) + 5))
        # In the foreground, timeout is not among those that it kills, and waits for the program.
        go_on killed timeout --foreground --preserve-status -s "$signal" "$(seconds $after)"
        if ((code == 0)); then
            check_all killed
            ((${#problems[@]} == 0)) || settle "$signal after the end"
            begin killed
            continue
        fi
        ((code == codes[$signal])) || problem "exit code $code: $(<"$work/messages")"
        check_wholes killed
        [[ $signal == KILL ]] || check_tidy killed
        ((++kill < kills)) || check_end killed
        settle "$signal after $after ms"
        # A job that is only done anew would find its file there, if it had just got its name.
        ((${#anew[@]} == 0)) || [[ $(results "$work/calm") != "$(results "$work/killed")" ]] ||
            begin killed
    done
done
