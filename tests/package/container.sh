#!/usr/bin/env bash
# Checks that packaging/Containerfile makes an image in which kiln runs: container.sh SOURCE WORK.
# If this fails, the container cannot be built or used. No container program is needed: each stage
# is run in a root folder of Debian. The step that makes a release is replaced by a copy of
# WORK/release, which the test package.release has made by the same command. At the end, kiln is run
# as the image's user.
set -euo pipefail
source=$1 work=$2
. "$(dirname "$0")/root.sh"
roots=$work/container
rm -rf "$roots"
mkdir -p "$roots"
stage="" root="" user=root folder=/ entry="" count=0

# run_step ROOT COMMAND: does a RUN step.
run_step() {
    [[ $2 != *tools/release* ]] || { mkdir -p "$1/release" && cp "$work"/release/* "$1/release/"; return; }
    inside "$1" sh -c "cd $folder && $2" >"$roots/log" 2>&1 || { tail -n 20 "$roots/log"; fail "RUN $2"; }
}
# copy_step WORD...: does a COPY step.
copy_step() {
    local from=$source to=${*: -1} file
    if [[ $1 == --from=* ]]; then
        from=$roots/${1#--from=}
        shift
    else
        # The build context is a clone of the last commit.
        git clone -q --no-local "file://$source" "$root$to"
        return
    fi
    mkdir -p "$root$to"
    while (($# > 1)); do
        for file in "$from"$1; do cp "$file" "$root$to"; done
        shift
    done
}
while IFS= read -r line; do
    read -r word rest <<<"$line"
    case $word in
    FROM)
        read -r image as stage <<<"$rest"
        [[ $image == debian:12* && ${as:-AS} == AS ]] || fail "FROM $rest: only Debian 12 is at hand"
        root=$roots/${stage:=last} folder=/
        make_root "$root"
        ;;
    RUN) run_step "$root" "$rest" ;;
    COPY) read -ra words <<<"$rest" && copy_step "${words[@]}" ;;
    WORKDIR) folder=$rest && mkdir -p "$root$folder" ;;
    USER) user=$rest ;;
    ENTRYPOINT) entry=$(jq -r '.[0]' <<<"$rest") ;;
    CMD) ;;
    *) fail "a step that is not known: $line" ;;
    esac
    count=$((count + 1))
done < <(sed -e ':a' -e '/\\$/N; s/\\\n//; ta' "$source/packaging/Containerfile" | grep -v '^\s*\(#\|$\)')

[[ $user == kiln && $entry == kiln ]] || fail "the image starts '$entry' as '$user'"
mkdir -p "$root/work"
cp -r "$source/scenes" "$root/work/"
chown -R 1000:1000 "$root/work"
started() { inside "$root" setpriv --reuid=kiln --regid=kiln --clear-groups sh -c "cd $folder && $entry $*"; }
started --version
started render scenes/campfire.yaml -o clip.mp4 --frames 0-4 --size 320x180 -q
[[ $(stat -c %u "$root/work/clip.mp4") == 1000 ]] || fail "the clip is not the user's"
! inside "$root" sh -c 'command -v gcc cmake git' || fail "the image has what only a build needs"
packages=$(inside "$root" dpkg-query -W | wc -l)
echo "$count steps; the image has $(du -sm --exclude=work "$root" | cut -f1) MB in $packages packages," \
    "a bare Debian $(tar -tvf "$work/base.tar" | awk '{ sum += $3 } END { printf "%d", sum / 1e6 }') MB"
rm -rf "$roots"
