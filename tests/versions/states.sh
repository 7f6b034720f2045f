#!/usr/bin/env bash
# Checks that scenes of an older version still load and have the same simulation states: states.sh
# KILN FOLDER ASSETS. If this fails, users' scenes break or look different after an upgrade. FOLDER
# has the scenes of that version and a file `states` with lines "SCENE FRAME HASH". A state may be
# changed on purpose; then CHANGELOG.md says why, and its line in `states` is changed.
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
