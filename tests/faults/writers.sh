#!/usr/bin/env bash
# Checks that two processes that write the same output at the same time do not break it: writers.sh
# KILN SCENE JOB TRIES. With --resume, one process must be refused with exit code 6 and a message,
# or both succeed one after the other; the refused command can then be run again. With --force and
# without --resume, at least one process must succeed, and the other may be refused with a message.
# In each case the output must have the bytes of an undisturbed run.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "two writers $job"
choose_job "$job" --fps 10 --set output.frames=41
draw_calm
command+=("${anew[@]}")

# write NUMBER: starts the job in the background and sets `process` to its process.
write() {
    (cd "$work/shared" && exec "$kiln" "${command[@]}" >/dev/null 2>"$work/messages.$1") &
    process=$!
}

# end NUMBER PROCESS: waits for a process and sets `code` to its exit code, which must be 0, or 6
# with a message.
end() {
    code=0
    wait "$2" || code=$?
    ((code == 0 || code == 6)) || problem "exit code $code: $(<"$work/messages.$1")"
    ((code == 0)) || grep -q '^kiln: ' "$work/messages.$1" || problem "it ends with 6 without a word"
}

for ((i = 0; i < tries; i++)); do
    begin shared
    write 1 && first=$process
    # The second process starts at once, or in every second try while the first is at work.
    ((i % 2 == 0)) || sleep "$(seconds $((RANDOM % calm_ms)))"
    write 2
    end 1 $first
    codes=$code
    end 2 $process
    codes+=$code
    [[ $codes != 66 ]] || problem "both are refused: $(cat "$work"/messages.[12])"
    if ((${#anew[@]} == 0)); then
        [[ $codes != *6* ]] || grep -q 'another process is writing this output' "$work"/messages.[12] ||
            problem "the refusal says: $(cat "$work"/messages.[12])"
        check_end shared
    fi
    check_all shared
    settle "pair $((i + 1)), codes $codes"
done
