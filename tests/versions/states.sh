#!/usr/bin/env bash
# Do the scenes of an older version still load, and step as they did? states.sh KILN FOLDER ASSETS: FOLDER
# has the scenes as that version had them and a file `states`, whose lines are "SCENE FRAME HASH". A state
# that changes is a decision: CHANGELOG.md says why, and the line here is changed with it.
set -euo pipefail
kiln=$1 folder=$2 assets=$3
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

failed=0 count=0
while read -r scene frame accepted; do
    count=$((count + 1))
    if ! "$kiln" render "$folder/$scene.yaml" --asset-root "$assets" --device cpu --size 32x18 --frames "$frame" \
        --progress none --json -o "$frames/$scene.png" >"$frames/said"; then
        echo "$scene: no longer renders"
        failed=1
        continue
    fi
    state=$(jq -r 'select(.event == "result").state' "$frames/said")
    [[ $state == "$accepted" ]] ||
        { echo "$scene: the state of frame $frame is $state, and was $accepted"; failed=1; }
done <"$folder/states"
scenes=("$folder"/*.yaml)
((count == ${#scenes[@]})) || { echo "$folder/states has $count of ${#scenes[@]} scenes"; failed=1; }
((failed == 0)) && echo "$count scenes load and step as they did"
