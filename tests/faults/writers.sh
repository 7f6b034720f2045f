#!/usr/bin/env bash
# writers.sh KILN SCENE JOB TRIES: of two that write one output at the same time with --resume, one is
# refused with exit code 6 and a message, the other ends with the bytes of an undisturbed run, and the
# refused one may then be run again. Two that write it without --resume but with --force both end, or one
# with a reason, and what stands there in the end is whole.
. "$(dirname "$0")/common.sh"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "two writers $job"
choose_job "$job" --fps 10 --set output.frames=41
draw_calm
command+=("${anew[@]}")

# write NUMBER: runs the job in the background; its process is `process`.
write() {
    (cd "$work/shared" && exec "$kiln" "${command[@]}" >/dev/null 2>"$work/messages.$1") &
    process=$!
}

# end NUMBER PROCESS: its exit code is `code`; another than these is a problem.
end() {
    code=0
    wait "$2" || code=$?
    ((code == 0 || code == 6)) || problem "exit code $code: $(<"$work/messages.$1")"
    ((code == 0)) || grep -q '^kiln: ' "$work/messages.$1" || problem "it ends with 6 without a word"
}

for ((i = 0; i < tries; i++)); do
    begin shared
    write 1 && first=$process
    # The second begins while the first is at work, or at the same time.
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
