#!/usr/bin/env bash
# Checks the scripts of examples/farm/slurm with stand-ins for the commands of Slurm, which run each
# job at once: tasks.sh KILN SOURCE. If this fails, a clip of several tasks is wrong, or a failed
# task is repeated when it should not be. The test farm.slurm runs the scripts on a real cluster.
set -euo pipefail
KILN=$(realpath "$1") source=$(realpath "$2")
submit=$source/examples/farm/slurm/submit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/jobs" "$work/clips"
export work KILN PATH=$work/bin:$PATH
echo 0 >"$work/jobs/last"
cd "$work/clips"
fail() {
    echo "$*"
    tail -n 5 -- *.tasks/*.log
    exit 1
}
stub() { cat >"$work/bin/$1" && chmod 755 "$work/bin/$1"; }

# The stand-in for sbatch runs the job, or each task of an array, and repeats a task as long as it
# asks for that by scontrol. A job is cancelled when the job on which it depends has failed. The
# file jobs/N gets the exit code of job N.
stub sbatch <<'END'
#!/usr/bin/env bash
id=$(($(<"$work/jobs/last") + 1)) tasks=("") result=0
while [[ $1 == --* ]]; do
    case $1 in
    --array=1-*????) echo "sbatch: error: Invalid job array specification" >&2; exit 1 ;;
    --array=1-*) mapfile -t tasks < <(seq "${1#--array=1-}") ;;
    --dependency=afterok:*) [[ $(<"$work/jobs/${1##*:}") == 0 ]] || result=cancelled ;;
    --output=*) log=${1#*=} ;;
    --parsable | --job-name=* | --kill-on-invalid-dep=yes) ;;
    *) echo "sbatch: unknown option $1" >&2; exit 1 ;;
    esac
    shift
done
echo "$id" >"$work/jobs/last"
export SLURM_JOB_ID=$id SLURM_CPUS_PER_TASK=1
for task in "${tasks[@]}"; do
    [[ $result != cancelled ]] || break
    unset SLURM_RESTART_COUNT
    [[ ! $task ]] || export SLURM_ARRAY_JOB_ID=$id SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=${#tasks[@]} \
        SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_STEP=1
    one=${log//%%/$'\1'} code=0
    one=${one//%a/$task}
    [[ $one != *%* ]] || { echo "sbatch: unknown pattern in $log" >&2; exit 1; }
    one=${one//$'\1'/%}
    bash "$@" >>"$one" 2>&1 || code=$?
    for ((times = 1; times < 20; times++)); do
        [[ -e $work/requeued.$id${task:+_$task} ]] || break
        rm "$work/requeued.$id${task:+_$task}"
        code=0
        SLURM_RESTART_COUNT=$times bash "$@" >>"$one" 2>&1 || code=$?
    done
    ((code == 0)) || result=$code
done
echo "$result" >"$work/jobs/$id"
echo "$id;cluster"
END
stub scontrol <<'END'
#!/usr/bin/env bash
[[ $1 == requeue ]] && touch "$work/requeued.$2"
END
stub scancel <<'END'
#!/usr/bin/env bash
echo "$*" >>"$work/cancelled"
END
stub squeue <<'END'
#!/usr/bin/env bash
echo "${STATE:-RUNNING}"
END
# The stand-in for kiln makes the first run of some commands fail, and then runs kiln. Each failure
# happens while its file in accidents/ is there: `planted` stands for a task that was taken over and
# puts links where later tasks write, `killed` stands for SIGKILL, `stopped` for SIGTERM
# to the script, `disk` for exit code 6 of a full disk, `always` for SIGKILL in every run of `bake`.
stub kiln <<'END'
#!/usr/bin/env bash
meet() { [[ $task == "$2" && -e $work/accidents/$1 ]]; }
task="$1 ${SLURM_ARRAY_TASK_ID:-}"
if meet always "bake "; then
    kill -KILL $$
elif meet killed "render 1"; then
    rm "$work/accidents/killed"
    kill -KILL $$
elif meet stopped "render 2"; then
    rm "$work/accidents/stopped"
    kill -TERM $PPID
    exec sleep 20
elif meet planted "render 1"; then
    # The sandbox lets a task write to the folder of its output.
    mkdir -p "$work/clips/taken/clip.mp4.tasks"
    ln -sf "$work/victim" "$work/clips/taken/clip.mp4.tasks/join.log"
elif meet disk "join "; then
    rm "$work/accidents/disk"
    exit 6
fi
exec "$KILN" "$@"
END

# expect JOB CODE NUMBER LOG...: checks the exit code of a job, and how often its logs say that a
# task was requeued.
expect() {
    local requeues
    requeues=$(cat "${@:4}" | grep -c ': requeued$' || true)
    [[ $(<"$work/jobs/$1") == "$2" && $requeues == "$3" ]] ||
        fail "job $1: ended with $(<"$work/jobs/$1") after $requeues requeues; expected $2 after $3"
}

cp "$source"/tests/cli/scenes/{tiny.yaml,puff.png} .
long=(tiny.yaml --device cpu --fps 2 --set output.frames=17)
mkdir "$work/accidents"
touch "$work/accidents"/{killed,stopped,disk}

# Tasks of parts and the join fail and are requeued; the clip must have the bytes of a single run.
said=$("$submit" tiny.yaml 'a clip.mp4' 3 "${long[@]:1}" -- --quality 90)
[[ $said == "jobs: bake 1, parts 2, join 3" ]] || fail "submit said: $said"
tasks='a clip.mp4.tasks'
expect 1 0 0 "$tasks/bake.log"
expect 2 0 2 "$tasks"/part-[123].log
expect 3 0 1 "$tasks/join.log"
kiln render "${long[@]}" --quality 90 --quiet -o single.mp4
cmp 'a clip.mp4' single.mp4
[[ -z $(ls "$work/accidents") ]] || fail "no accident: $(ls "$work/accidents")"
[[ $(jq -s 'map(select(.event == "started")) | length' "$tasks/part-2.ndjson") == 1 ]] ||
    fail "the events of task 2 are not its own"

# Submitted again, the tasks must find the clip whole and draw nothing.
"$submit" tiny.yaml 'a clip.mp4' 3 "${long[@]:1}" -- --quality 90 >/dev/null
expect 5 0 2 "$tasks"/part-[123].log
[[ $(grep -h '"event": "result"' "$tasks"/part-[123].ndjson | grep -c '"frames": 0, ') == 3 ]] ||
    fail "tasks draw frames of a clip that is whole"
cmp 'a clip.mp4' single.mp4

# The output may be images. Their %02d, which is part of the names of the logs, must be escaped:
# sbatch would take it for a pattern. The second submission must resume.
for parts in 8 11; do
    "$submit" tiny.yaml f_%02d.png 1 --device cpu -- --frames 0-1 >/dev/null
    expect $((parts - 1)) 0 0 f_%02d.png.tasks/bake.log
    expect $parts 0 0 f_%02d.png.tasks/{part-1,join}.log
    [[ $(echo f_*.png) == "f_00.png f_01.png" ]] || fail "images: $(echo f_*.png)"
done

# A task that can never succeed must not be repeated, and the jobs that depend on it must not begin.
"$submit" tiny.yaml wrong.mp4 1 --set seed=none >/dev/null
expect 13 3 0 wrong.mp4.tasks/bake.log
expect 14 cancelled 0 /dev/null
expect 15 cancelled 0 /dev/null
"$submit" tiny.yaml large.mp4 1 "${long[@]:1}" -- --limits output=1kB >/dev/null
expect 17 8 0 large.mp4.tasks/part-1.log
expect 18 cancelled 0 /dev/null
grep -q 'more memory' large.mp4.tasks/part-1.log || fail "the log does not say that more is needed"

# A task that fails FARM_REQUEUES times more must be given up. A task whose state is COMPLETING was
# cancelled, and must not be requeued.
touch "$work/accidents/always"
FARM_REQUEUES=1 "$submit" tiny.yaml fails.mp4 1 >/dev/null
expect 19 137 1 fails.mp4.tasks/bake.log
STATE=COMPLETING "$submit" tiny.yaml gone.mp4 1 >/dev/null
expect 22 137 0 gone.mp4.tasks/bake.log

# A wrong number of tasks must be refused before anything is submitted. When Slurm refuses a job,
# the jobs that were submitted before it must be cancelled.
rm "$work/accidents/always"
submitted=$(<"$work/jobs/last")
for tasks in 0 -1 two 1.5; do
    said=$("$submit" tiny.yaml none.mp4 $tasks 2>&1) && fail "submit takes $tasks tasks"
    [[ $said == "submit: TASKS: found '$tasks', expected a whole number from 1 on" ]] || fail "submit said: $said"
done
[[ $(<"$work/jobs/last") == "$submitted" && ! -e none.mp4.tasks ]] || fail "a job was submitted all the same"
! "$submit" tiny.yaml many.mp4 5000 2>/dev/null || fail "submit does not tell that Slurm refused a job"
[[ $(<"$work/cancelled") == $((submitted + 1)) ]] || fail "cancelled are: $(<"$work/cancelled")"

# A task that was taken over must not put a link in the place of a log that Slurm writes later: the
# logs lie outside of the folder of the output. The same task succeeds where they lie in it.
touch "$work/accidents/planted"
for folder in "$work/clips/taken/clip.mp4.tasks" "$work/clips/-tasks of a clip"; do
    rm -rf "$work/victim" taken
    mkdir taken
    FARM_TASKS=$folder "$submit" tiny.yaml taken/clip.mp4 1 "${long[@]:1}" >/dev/null
    [[ -s $folder/part-1.log || -e $folder/part-1.ndjson ]] || fail "no logs in $folder"
    case $folder in
    *clips/taken*) [[ -e $work/victim ]] || fail "the attack is none" ;;
    *) [[ ! -e $work/victim ]] || fail "Slurm wrote to a file of somebody else" ;;
    esac
done
