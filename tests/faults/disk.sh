#!/usr/bin/env bash
# Checks how a job ends whose disk is full or read-only: disk.sh KILN SCENE JOB TRIES. If this
# fails, a full disk leaves broken files, or the user does not learn the reason. The job must end
# with exit code 6 and a message that names the file and the reason, and leave no half-written file.
# When there is room, it must end with the bytes of an undisturbed run. The disk has room for one
# page (4 KiB) at first, then for more and more, in about TRIES tries, until all files fit.
. "$(dirname "$0")/common.sh"
with_mounts "$0" "$@"
kiln=$1 scene=$(realpath "$2") job=$3 tries=$4
start "full disk $job"
choose_job "$job" --fps 1 --set simulation.rate=10 --set output.frames=6 --set 'output.size=[192, 108]'
draw_calm
mkdir "$work/disk"

# pages FOLDER: prints the number of pages (4 KiB) that the files of a folder take.
pages() {
    find "$1" -type f -printf '%s\n' | awk '{ pages += int(($1 + 4095) / 4096) } END { print pages + 0 }'
}

# check_refused REASON: checks that the job ended as one must that cannot write for this reason.
check_refused() {
    ((code == 6)) || problem "exit code $code: $(<"$work/messages")"
    grep -q "^kiln: out[^ ]*: .*$1\$" "$work/messages" || problem "it says: $(<"$work/messages")"
    check_wholes disk
    check_tidy disk
}

begun=$(pages "$work/before")
step=$(($(pages "$work/calm") / tries + 1))
room=1
fits=no
while [[ $fits == no ]]; do
    mount -t tmpfs -o size=$(((begun + room) * 4))k none "$work/disk"
    cp -a "$work/before/." "$work/disk"
    go_on disk
    if ((code == 0)); then
        check_all disk
        fits=yes
    else
        check_refused 'No space left on device'
        mount -o remount,size=64m "$work/disk"
        check_end disk
    fi
    settle "room for $room pages"
    umount "$work/disk"
    room=$((room + 1 + RANDOM % (step + room / 2)))
done

mount -t tmpfs none "$work/disk"
cp -a "$work/before/." "$work/disk"
mount -o remount,ro "$work/disk"
go_on disk
check_refused 'Read-only file system'
mount -o remount,rw "$work/disk"
check_end disk
settle 'only to be read'
