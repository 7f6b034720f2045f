#!/usr/bin/env bash
# Checks that a Slurm cluster renders a clip with the bytes of a single run although its tasks are
# preempted, stopped, killed and requeued: slurm.sh KILN SOURCE. If this fails, a clip that a farm
# renders is lost or wrong. The script also checks that a cancelled task stays cancelled, that a
# task that can never succeed is not repeated, and that the commands of docs/farm.md work.
set -euo pipefail
kiln=$(realpath "$1") source=$(realpath "$2")
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/cluster.sh"
submit=$source/examples/farm/slurm/submit
began=$SECONDS
say() { printf '%4d s  %s\n' $((SECONDS - began)) "$*"; }
fail() {
    say "failed: $*"
    squeue --format='%.8i %.20j %T %r'
    tail -n 20 -- *.tasks/*.log
    exit 1
}

work=$(mktemp -d)
trap 'stop_cluster; rm -rf "$work"' EXIT
chmod 755 "$work"
mkdir "$work/clips"
cd "$work/clips"
PATH=$(dirname "$kiln"):$PATH
start_cluster "$work/cluster" 8
say "a cluster of one node runs: $(sinfo --version), $(kiln --version)"

# until_true SECONDS WHAT COMMAND...: waits until the command succeeds. WHAT describes the event in
# the message of a failure.
until_true() {
    local last=$((SECONDS + $1)) what=$2
    until "${@:3}"; do
        ((SECONDS < last)) || fail "for $1 s: $what"
        sleep 0.05
    done
}
is_gone() { [[ -z $(squeue --noheader --jobs="$1" 2>/dev/null) ]]; }
is_told() { grep -qs "$2" "$1"; }

# start SCENE OUTPUT TASKS [OPTION...]: submits the jobs of a clip. Sets `bake`, `parts` and `join`
# to the numbers of the jobs, and `clip` to OUTPUT.
start() {
    local said
    said=$("$submit" "$@")
    [[ $said =~ ^jobs:\ bake\ ([0-9]+),\ parts\ ([0-9]+),\ join\ ([0-9]+)$ ]] || fail "submit said: $said"
    bake=${BASH_REMATCH[1]} parts=${BASH_REMATCH[2]} join=${BASH_REMATCH[3]} clip=$2
    say "$2: submitted as jobs $bake, $parts and $join"
}

# catch TASK...: waits until each of the tasks has finished a part, and suspends its kiln in the
# middle of the next part. Sets caught[TASK] to the process of kiln.
declare -A caught
is_caught() {
    local task events
    for task; do
        events=$clip.tasks/part-$task.ndjson
        if [[ ! ${caught[$task]:-} ]] && grep -qs '"event": "part"' "$events"; then
            caught[$task]=$(grep '"event": "started"' "$events" | tail -n 1 | jq .process)
            kill -STOP "${caught[$task]}" || fail "task $task ended before it could be disturbed"
        fi
    done
    ((${#caught[@]} == $#))
}
catch() {
    caught=()
    until_true 120 "a part of each of the tasks $* of $clip" is_caught "$@"
}

# requeued TASK WHO: waits until the log says that the task goes back into the queue, by its own
# script or by Slurm.
requeued() {
    local said="task: exit code .*: requeued"
    [[ $2 == script ]] || said="DUE TO \(JOB REQUEUE\|PREEMPTION\)"
    until_true 60 "task $1 is requeued by $2" is_told "$clip.tasks/part-$1.log" "$said"
    say "$clip: part task $1 is requeued by $2: $(grep -o "$said" "$clip.tasks/part-$1.log" | tail -n 1)"
}
# is_warned PROCESS: succeeds if signal 15 (SIGTERM), bit 14 of ShdPnd, is pending for the process.
is_warned() { (((0x$(awk '/^ShdPnd/ { print $2 }' "/proc/$1/status") >> 14) & 1)); }

say "docs/farm.md, section Slurm, as a new user:"
"$source/tests/docs/console.py" --only Slurm "$kiln" "$source/docs/farm.md"

cp "$source/scenes/fire_beam.yaml" .
cp -r "$source/scenes/textures" .
film=(fire_beam.yaml --device cpu --set output.frames=960)
single() { kiln render "${film[@]}" --size 320x180 --quiet -o "$@"; }

start "${film[0]}" farm.mp4 8 "${film[@]:1}" -- --size 320x180
catch 1 2 3 4
say "farm.mp4: tasks 1 to 4 run; an urgent job takes the node from them"
sbatch --quiet --partition=urgent --exclusive --output=urgent.log --wrap='sleep 1'
for task in 1 2 3 4; do
    requeued $task Slurm
done
catch 5 6 7 8
say "farm.mp4: scancel --signal=TERM of task 5"
scancel --signal=TERM --batch "${parts}_5"
sleep 1
kill -CONT "${caught[5]}"
requeued 5 script
say "farm.mp4: kill -9 of the kiln of task 6"
kill -KILL "${caught[6]}"
requeued 6 script
say "farm.mp4: scontrol requeue of task 7"
scontrol requeue "${parts}_7"
requeued 7 Slurm
say "farm.mp4: task 8 stalls, and has two minutes in all"
scontrol update "job=${parts}_8" TimeLimit=2
stalled=${caught[8]}

# ended STATE: waits until all jobs of the clip have ended, and checks the state of its join:
# COMPLETED, or CANCELLED because a job before it failed.
ended() {
    until_true 120 "the jobs of $clip end" is_gone "$bake,$parts,$join"
    grep -q "^JobId=$join .* JobState=$1 " "$work/cluster/jobs.log" ||
        fail "the join of $clip is not $1: $(grep "^JobId=$join " "$work/cluster/jobs.log")"
}
# started STEM: prints how often kiln was started for a task.
started() { grep -c '"event": "started"' "$clip.tasks/$1.ndjson"; }

# hopeless STEM "CODE AGAIN MESSAGE" SCENE OUTPUT OPTION...: checks that the task fails once, is not
# repeated, and that its events have the exit code, the word of the exit codes' table that says
# whether to try again, and the message.
hopeless() {
    local bake parts join clip said stem=$1
    start "$3" "$4" 2 "${@:5}"
    ended CANCELLED
    said=$(jq -r 'select(.event == "error") | "\(.code) \(.again) \(.message)"' "$clip.tasks/$stem.ndjson")
    # shellcheck disable=SC2053
    [[ $said == $2 ]] || fail "$clip: the events of $stem say: $said"
    [[ $(started "$stem") == 1 && ! -e $clip ]] || fail "$clip: $stem was repeated"
    say "$clip: $stem ends at once, with $said"
    say "$clip: $(grep -h ^task: "$clip.tasks/$stem.log")"
}
sed 's/rate: 75/raet: 75/' fire_beam.yaml >broken.yaml
hopeless bake "3 never broken.yaml:*: unknown key*'rate'*" broken.yaml broken.mp4 --device cpu
hopeless bake "8 with more *the limit \`frames\` is 10" "${film[0]}" long.mp4 "${film[@]:1}" --limits frames=10
hopeless part-1 "8 with more *limit*output*" "${film[0]}" large.mp4 "${film[@]:1}" -- --size 64x36 --limits output=1kB

# A user cancels the parts of a clip: no task may be repeated. Submitted again, the clip must have
# the bytes of a single run.
cancel() {
    local bake parts join clip two=("${film[0]}" cancelled.mp4 2 --device cpu --set output.frames=240 -- --size 320x180)
    start "${two[@]}"
    catch 1
    say "$clip: scancel of its parts"
    scancel "$parts"
    ended CANCELLED
    [[ $(started part-1) == 1 && ! -e $clip ]] || fail "a task was repeated after scancel"
    start "${two[@]}"
    ended COMPLETED
    single straight.mp4 --set output.frames=240
    cmp "$clip" straight.mp4
    say "$clip: has the bytes of a single run; $(kept part-1) frames were kept"
}
# kept STEM: prints how many frames the last run of a task has kept from runs before it.
kept() { jq -s 'map(select(.event == "result")) | last.kept' "$clip.tasks/$1.ndjson"; }
cancel

until_true 120 "Slurm warns task 8 of its time limit" is_warned "$stalled"
say "farm.mp4: Slurm warns task 8 that its time is over soon; it stalls no more"
kill -CONT "$stalled"
requeued 8 script
ended COMPLETED
single single.mp4
cmp farm.mp4 single.mp4
for task in {1..8}; do
    (($(started "part-$task") >= 2 && $(kept "part-$task") > 0)) || fail "task $task did not go on where it was"
done
say "farm.mp4: has the bytes of a single run; every task was disturbed, and kept what it had"

echo "What Slurm noted (jobcomp/filetxt):"
awk '{
    for (key in field)
        delete field[key]
    for (i = 1; i <= NF; i++)
        if (split($i, pair, "=") == 2)
            field[pair[1]] = pair[2]
    printf "  job %-3s %-6s %-3s %-10s %s to %s\n", field["JobId"], field["Name"], field["ArrayTaskId"], field["JobState"],
        substr(field["StartTime"], 12), substr(field["EndTime"], 12)
}' "$work/cluster/jobs.log"
