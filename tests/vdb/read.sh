#!/usr/bin/env bash
# Compares what OpenVDB's vdb_print reads of files of gas with the texts of expected/: read.sh WRITE
# FOLDER [--update]. WRITE is the program of write.c. Lines about memory are left out, since they
# depend on the version of OpenVDB. vdb_render must draw the files, too.
set -euo pipefail
write=$1 folder=$2
for tool in vdb_print vdb_render; do
    command -v "$tool" >/dev/null || { echo "skipped: there is no $tool (tools/setup installs it)"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$write" "$work"

failed=0
for file in "$work"/*.vdb; do
    name=$(basename "$file" .vdb)
    { vdb_print -m "$file"; vdb_print -l "$file"; } |
        sed -nE -e '/\((In Core|Total)\)/s/ +[0-9.]+[KMG]?B \(.*//' \
            -e '/ootprint|VDB version|Dense equivalent|Active leaf voxels|Actual:/d' -e 's/ +$//' -e '/./p' >"$work/$name.txt"
    [[ ${3:-} != --update ]] || cp "$work/$name.txt" "$folder/expected/"
    diff -u "$folder/expected/$name.txt" "$work/$name.txt" || failed=1
done
cd "$work" # vdb_render takes a point in the name of a folder for that of a suffix
vdb_render half.vdb half.ppm -res 64x64 -translate 0,-12,3 -lookat 0,0,3 -up 0,0,1 >/dev/null
# The ball is lit on its right; the picture's corners are black.
brightest=$(od -An -v -tu1 -w3 -j13 half.ppm | awk '$1 > most { most = $1; at = NR - 1 } END { print most, at % 64 }')
read -r most column <<<"$brightest"
((most > 50 && column > 32 && column < 50)) || { echo "vdb_render drew another picture: $brightest"; failed=1; }
exit $failed
