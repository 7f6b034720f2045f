#!/usr/bin/env bash
# Checks that a job makes the same files when its cache cannot be used: cache.sh KILN SCENE DEVICE.
# If this fails, a job fails or differs only because of its cache, which may only save time. The
# cache's folder is on a full disk, read-only, impossible to make, or a file. SCENE has a mesh whose
# distance field is cached. With the device `software`, Mesa caches its shaders there, too. Then the
# full disk is left out: Mesa 22.3 writes into a mapped file for which there is no room, and dies of
# SIGBUS.
. "$(dirname "$0")/common.sh"
with_mounts "$0" "$@"
kiln=$1 scene=$(realpath "$2") device=$3
start "cache $device"
choose_job png
command+=(--device "$device")
export XDG_CACHE_HOME=$work/cache
unset MESA_SHADER_CACHE_DIR
mkdir "$XDG_CACHE_HOME"
draw_calm
[[ -n $(find "$XDG_CACHE_HOME" -type f) ]] || problem 'nothing was cached, so that this proves nothing'

# check_cache WHAT: runs the job with the present cache and checks its files. WHAT names the cache
# in messages.
check_cache() {
    begin other
    go_on other
    ((code == 0)) || problem "exit code $code: $(<"$work/messages")"
    check_all other
    settle "$1"
}

mkdir "$work/disk"
XDG_CACHE_HOME=$work/disk
mount -t tmpfs -o size=4k none "$work/disk"
if [[ $device == cpu ]]; then
    check_cache 'on a full disk'
    left=$(find "$work/disk" -type f)
    [[ -z $left ]] || problem "half of a field was cached: $left"
fi
mount -o remount,ro "$work/disk"
check_cache 'only to be read'
XDG_CACHE_HOME=$work/disk/none
check_cache 'that cannot be made'
touch "$work/file"
XDG_CACHE_HOME=$work/file
check_cache 'that is a file'
