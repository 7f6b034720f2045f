#!/usr/bin/env bash
# Checks that a job that is killed and resumed, again and again, ends with the files of an
# undisturbed job: kills.sh KILN SCENE JOB KILLS SIGNAL... If this fails, a kill loses or breaks
# files. The job is killed KILLS times by each signal, at random times. After each kill, the exit
# code must be the documented one and each finished file must be whole. After a signal other than
# KILL, on which kiln can clean up, no half-written file may be left.
kiln=$1 scene=$(realpath "$2") job=$3 kills=$4
. "$(dirname "$0")/common.sh"
shift 4
start "kill $job"

# The clip has 61 frames at 10 a second, so that it has several parts, of two seconds each. The
# saved states of `bake` are large, so that a kill often comes while one is being written.
options=(--fps 10 --set output.frames=61)
[[ $job != bake ]] || options+=(--set systems.smoke.emit.rate=8000)
GRID=7x7 choose_job "$job" "${options[@]}"
draw_calm

declare -A codes=([KILL]=137 [TERM]=143 [INT]=130)
for signal in "$@"; do
    begin killed
    for ((kill = 0; kill < kills;)); do
        after=$((RANDOM % (calm_ms + calm_ms / 4) + 5))
        # With --foreground, timeout does not kill itself with the program, and waits for the
        # program's end.
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
        # A job that cannot be resumed refuses to replace a file. If the kill came just after the
        # job had finished all files, the next try needs a new folder.
        ((${#anew[@]} == 0)) || [[ $(results "$work/calm") != "$(results "$work/killed")" ]] ||
            begin killed
    done
done
