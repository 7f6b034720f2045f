# What the scripts of this folder share, which source it: the jobs that faults happen to, what is true
# of a job's files whatever happened, and the count of faults that were tried and survived.
#
# A script sets `kiln` and `scene`, calls start, choose_job and draw_calm, and then causes one fault
# after the other: problem notes what is wrong, settle counts. RANDOM_SEED=N repeats a run.
set -euo pipefail

# start NAME: makes the folder `work`, which goes when the script ends. NAME stands in the table.
start() {
    row=$1 tried=0 survived=0 problems=()
    seed=${RANDOM_SEED:-$$}
    RANDOM=$seed
    work=$(mktemp -d)
    trap 'finish $?' EXIT
    mkdir "$work/before" "$work/calm"
}

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

problem() {
    problems+=("$*")
}

# settle WHAT: the fault is over.
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

# choose_job JOB [OPTION...]: the words of its command in the array `command`, with options of the
# scene. A job writes below out/ and can be gone on with by the same words; one that can only be done
# anew takes those of the array `anew`, too. GRID is a flipbook's.
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

# draw_calm: what the job begins with in the folder `before`, and what it ends with in `calm`, where
# nothing disturbs it. Its milliseconds are `calm_ms`.
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

# begin FOLDER: makes it anew as the job finds it.
begin() {
    rm -rf "${work:?}/$1"
    cp -a "$work/before" "$work/$1"
}

# The files of a folder under their final names: not a journal, a part of a clip or a temporary file.
# Of the manifest only a member is the same in each run.
results() {
    find "$1" -type f ! -name '*.journal' ! -name '*.part' ! -name '.*.tmp' ! -name m.json -printf '%P\n' | sort
}

# Whether a manifest is whole: that of a run that failed says so, and which frames are missing.
has_same_result() {
    jq -e '.failed and .run.error and .result.missing >= 0' "$work/$1/out/m.json" >/dev/null 2>&1 ||
        cmp -s <(jq -S .result "$work/calm/out/m.json") <(jq -S .result "$work/$1/out/m.json" 2>&1)
}

# check_wholes FOLDER: what stands under a final name is what the undisturbed job made.
check_wholes() {
    local file
    while read -r file; do
        cmp -s "$work/calm/$file" "$work/$1/$file" || problem "$file is not whole"
    done < <(results "$work/$1")
    [[ ! -e $work/$1/out/m.json ]] || has_same_result "$1" || problem "the manifest is not whole"
}

# check_all FOLDER: it has all of the undisturbed job's files, and nothing else.
check_all() {
    local left
    check_wholes "$1"
    [[ $(results "$work/calm") == "$(results "$work/$1")" ]] || problem "other files than undisturbed"
    [[ ! -e $work/calm/out/m.json || -e $work/$1/out/m.json ]] || problem "no manifest"
    left=$(find "$work/$1" -name '.*.tmp' -o -name '*.parts' -o -name '*.part')
    [[ -z $left ]] || problem "left behind: $left"
}

# check_tidy FOLDER: no file is left half-written.
check_tidy() {
    local left
    left=$(find "$work/$1" -name '.*.tmp')
    [[ -z $left ]] || problem "half-written: $left"
}

# check_no_bug: the C library found no broken heap, and no assertion failed, before the end.
check_no_bug() {
    ! grep -qE 'free\(\)|malloc\(\)|realloc\(\)|double free|corrupted|smashing|Assertion `' "$work/messages" ||
        problem "a bug ends it: $(<"$work/messages")"
}

# go_on FOLDER [WORD...]: runs the job there, behind such a program; `code` gets its exit code, the
# file `messages` what it said.
go_on() {
    local folder=$1
    shift
    code=0
    # The outer redirection takes what the shell says of a program that was killed.
    { (cd "$work/$folder" && "$@" "$kiln" "${command[@]}" >"$work/output" 2>"$work/messages") || code=$?; } 2>/dev/null
    check_no_bug
}

# check_end FOLDER: going on ends with the bytes of the undisturbed job.
check_end() {
    local command=("${command[@]}" "${anew[@]}")
    go_on "$1"
    ((code == 0)) || problem "going on ends with $code: $(<"$work/messages")"
    check_all "$1"
}

# with_mounts "$0" "$@": runs the script anew where it may mount file systems that nobody else sees. It
# counts as skipped where that is not permitted.
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

# seconds MILLISECONDS, for timeout and sleep.
seconds() {
    printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000))
}
