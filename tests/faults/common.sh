# Defines functions for the scripts of this folder, which source it. The functions run the jobs to
# which faults happen, check the jobs' files, and count the faults that were tried and survived.
#
# A script sets `kiln` and `scene`, and calls start, choose_job and draw_calm. Then it causes one
# fault after the other. After each fault it calls `problem` for everything that is wrong, and then
# `settle`, which counts. RANDOM_SEED=N repeats a run.
set -euo pipefail

# start NAME: makes the folder `work`, which is removed when the script ends. NAME is the script's
# row in the table that table.sh prints.
start() {
    row=$1 tried=0 survived=0 problems=()
    seed=${RANDOM_SEED:-$$}
    RANDOM=$seed
    work=$(mktemp -d)
    trap 'finish $?' EXIT
    mkdir "$work/before" "$work/calm"
}

# finish CODE: removes the folder, prints the script's row and exits. A script that ends with CODE 0
# or 1 fails if a fault was not survived, or none was tried.
finish() {
    [[ ! -e $work/disk ]] || umount -q "$work/disk" || true
    rm -rf "$work"
    [[ $1 == 0 || $1 == 1 ]] || exit "$1"
    local line
    line=$(printf '%-28s %5d tried %5d survived' "$row" "$tried" "$survived")
    echo "$line"
    [[ -z ${KILN_FAULT_ROWS:-} ]] || echo "$line" >"$KILN_FAULT_ROWS/${row// /_}"
    ((tried > 0 && survived == tried)) || exit 1
    exit "$1"
}

# problem TEXT: records something wrong that the present fault has caused.
problem() {
    problems+=("$*")
}

# settle WHAT: ends the present fault, which WHAT describes: counts it as survived if it caused no
# problem, else prints the problems.
settle() {
    tried=$((tried + 1))
    if ((${#problems[@]} == 0)); then
        survived=$((survived + 1))
    else
        local each
        for each in "${problems[@]}"; do
            echo "$row, $1 (RANDOM_SEED=$seed): $each" >&2
        done
    fi
    problems=()
}

# choose_job JOB [OPTION...]: sets the array `command` to kiln's arguments for a job, with options
# for the scene. The job writes below out/. The same arguments resume the job after a fault; a job
# that cannot be resumed starts again with the arguments of the array `anew` added. The array
# `before` has the arguments of a command that makes the job's input, two shards of images or of a
# clip. GRID is the grid of a flipbook.
choose_job() {
    local job=$1
    shift
    local of_scene=("$scene" -q --device cpu "$@") manifest=(--manifest out/m.json)
    local render=(render "${of_scene[@]}" "${manifest[@]}" --resume)
    before=() anew=()
    case $job in
    png | exr) command=("${render[@]}" -o "out/f_%03d.$job") ;;
    mp4 | webm | gif) command=("${render[@]}" -o "out/c.$job") ;;
    straight_png)
        command=(render "${of_scene[@]}" "${manifest[@]}" -o out/f_%03d.png)
        anew=(--force)
        ;;
    straight_mp4)
        command=(render "${of_scene[@]}" "${manifest[@]}" -o out/c.mp4)
        anew=(--force)
        ;;
    flipbook)
        command=("${render[@]}" -o out/book.png --flipbook "${GRID:-2x2}" --flipbook-motion
            --set backdrop.transparent=true)
        ;;
    bake) command=(bake "${of_scene[@]}" -o out/states --every 1 --resume) ;;
    join)
        command=(join out/c.mp4 -q "${manifest[@]}")
        before=(render "${of_scene[@]}" -o out/c.mp4 --shard)
        ;;
    encode)
        command=(encode in/f_%02d.png -q -o out/c.mp4)
        anew=(--force)
        before=(render "${of_scene[@]}" -o in/f_%02d.png --shard)
        ;;
    compare)
        command=(compare out/f_00.png out/f_00.png -q --diff out/difference.png)
        before=(render "${of_scene[@]}" -o out/f_%02d.png --frames 0-1 --shard)
        ;;
    check) command=(check "${of_scene[@]:0:2}") ;;
    plan) command=(plan "$scene" --device cpu "$@") ;;
    *) echo "no job is called $job" >&2 && exit 2 ;;
    esac
}

# draw_calm: makes the job's input in the folder `before`, and runs the job without a fault in the
# folder `calm`. Sets `calm_ms` to the milliseconds that it took.
draw_calm() {
    local begun share
    mkdir -p "$work/before/out"
    for share in ${before[0]:+1/2 2/2}; do
        (cd "$work/before" && "$kiln" "${before[@]}" "$share")
    done
    begin calm
    begun=$(date +%s%N)
    (cd "$work/calm" && "$kiln" "${command[@]}" >"$work/calm.output")
    calm_ms=$((($(date +%s%N) - begun) / 1000000 + 1))
}

# begin FOLDER: makes a new folder with the job's input.
begin() {
    rm -rf "${work:?}/$1"
    cp -a "$work/before" "$work/$1"
}

# results FOLDER: lists the finished files of a folder, without journals, parts of clips and
# temporary files. The manifest is left out, too: only its member `result` is the same in each run.
results() {
    find "$1" -type f ! -name '*.journal' ! -name '*.part' ! -name '.*.tmp' ! -name m.json -printf '%P\n' | sort
}

# has_same_result FOLDER: succeeds if the manifest has the result of the undisturbed job, or says
# that the run failed, why, and how many frames are missing.
has_same_result() {
    jq -e '.failed and .run.error and .result.missing >= 0' "$work/$1/out/m.json" >/dev/null 2>&1 ||
        cmp -s <(jq -S .result "$work/calm/out/m.json") <(jq -S .result "$work/$1/out/m.json" 2>&1)
}

# check_wholes FOLDER: checks that each finished file has the bytes of the undisturbed job's file.
check_wholes() {
    local file
    while read -r file; do
        cmp -s "$work/calm/$file" "$work/$1/$file" || problem "$file is not whole"
    done < <(results "$work/$1")
    [[ ! -e $work/$1/out/m.json ]] || has_same_result "$1" || problem "the manifest is not whole"
}

# check_all FOLDER: checks that it has all files of the undisturbed job, and no others.
check_all() {
    local left
    check_wholes "$1"
    [[ $(results "$work/calm") == "$(results "$work/$1")" ]] || problem "other files than undisturbed"
    [[ ! -e $work/calm/out/m.json || -e $work/$1/out/m.json ]] || problem "no manifest"
    left=$(find "$work/$1" -name '.*.tmp' -o -name '*.parts' -o -name '*.part')
    [[ -z $left ]] || problem "left behind: $left"
}

# check_tidy FOLDER: checks that no half-written file is left.
check_tidy() {
    local left
    left=$(find "$work/$1" -name '.*.tmp')
    [[ -z $left ]] || problem "half-written: $left"
}

# check_no_bug: checks that the last run printed no message of a broken heap or a failed assertion.
check_no_bug() {
    ! grep -qE 'free\(\)|malloc\(\)|realloc\(\)|double free|corrupted|smashing|Assertion `' "$work/messages" ||
        problem "a bug ends it: $(<"$work/messages")"
}

# go_on FOLDER [WORD...]: runs the job in the folder. The words, such as `timeout 60`, precede the
# command. Sets `code` to the exit code, and leaves standard error in the file `messages`.
go_on() {
    local folder=$1
    shift
    code=0
    # The outer redirection hides the shell's own message that a program was killed.
    { (cd "$work/$folder" && "$@" "$kiln" "${command[@]}" >"$work/output" 2>"$work/messages") || code=$?; } 2>/dev/null
    check_no_bug
}

# check_end FOLDER: resumes the job, or runs it again if it cannot be resumed, and checks that it
# ends with the files of the undisturbed job.
check_end() {
    local command=("${command[@]}" "${anew[@]}")
    go_on "$1"
    ((code == 0)) || problem "going on ends with $code: $(<"$work/messages")"
    check_all "$1"
}

# with_mounts "$0" "$@": runs the script again in a mount namespace of its own, where it may mount
# file systems. Skips the test (77) where that is not permitted.
with_mounts() {
    [[ -z ${KILN_HAS_MOUNTS:-} ]] || return 0
    local unshare=(unshare --mount)
    ((EUID == 0)) || unshare+=(--map-root-user)
    if ! "${unshare[@]}" mount -t tmpfs none /mnt 2>/dev/null; then
        echo "no file system may be mounted here"
        exit 77
    fi
    KILN_HAS_MOUNTS=1 exec "${unshare[@]}" "$@"
}

# seconds MILLISECONDS: prints a time in seconds, for timeout and sleep.
seconds() {
    printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000))
}
