#!/usr/bin/env bash
# Checks that programs that share no code with kiln read its pictures as kiln does: readers.sh KILN
# FOLDER. If this fails, kiln writes files that other programs show differently, and its own tests
# do not notice. Pillow reads the PNG files, by a decoder of its own. FFmpeg reads the EXR files and
# writes them again, by a decoder and an encoder of its own; kiln uses OpenEXR.
set -euo pipefail

kiln=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

failed=0 count=0
while IFS= read -r picture; do
    count=$((count + 1))
    case $picture in
    *.png)
        /usr/bin/python3 -c 'import sys; from PIL import Image
picture = Image.open(sys.argv[1]); assert picture.mode == "RGB", picture.mode
sys.stdout.buffer.write(b"P6 %d %d 255\n" % picture.size + picture.tobytes())' \
            "$picture" >"$work/read.ppm"
        ffmpeg -nostdin -loglevel error -y -i "$work/read.ppm" "$work/read.png"
        again=$work/read.png
        ;;
    *.exr)
        again=$work/read.exr
        ffmpeg -nostdin -loglevel error -y -i "$picture" "$again"
        ;;
    esac
    if ! "$kiln" compare --quiet --layer beauty --tolerance abs.max=0 "$picture" "$again"; then
        echo "$picture: another program reads another picture" >&2
        failed=1
    fi
done < <(find "$folder" -name 'frame_*.png' -o -name 'frame_*.exr' | sort)
echo "$count pictures"
((count > 0)) || failed=1
exit "$failed"
