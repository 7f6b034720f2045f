#!/usr/bin/env bash
# mutation.sh KILN SOURCE GOLDEN FRAME NAME [--set KEY=VALUE | FILE EXPRESSION]...
#
# Draws a frame of the fire beam with one deliberate fault, by an override of the scene or by a sed
# expression on a shader, and passes if `kiln compare` sees it in the picture alone.
set -euo pipefail

kiln=$1 source=$2 golden=$3 frame=$4 name=$5
shift 5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

overrides=()
cp -r "$source/shaders" "$work/shaders"
while (($# >= 2)); do
    if [[ $1 == --set ]]; then
        overrides+=(--set "$2")
    else
        sed -i "$2" "$work/shaders/$1"
        if cmp -s "$work/shaders/$1" "$source/shaders/$1"; then
            echo "$name: the expression '$2' changes nothing in shaders/$1" >&2
            exit 2
        fi
    fi
    shift 2
done

# The compute technique, so that faults of the step can be made in its shader as well.
KILN_SHADER_DIR=$work/shaders "$kiln" render "$source/scenes/fire_beam.yaml" --size 320x180 \
    --frames "$frame" --device software --technique simulate=inplace --quiet \
    "${overrides[@]}" -o "$work/frame.png"

status=0
"$kiln" compare "$golden" "$work/frame.png" || status=$?
if [[ $name == none ]]; then
    exit "$status" # without a fault the pictures are the same
fi
if ((status == 1)); then
    exit 0
fi
echo "$name: the fault was not seen (kiln compare gave $status)" >&2
exit 1
