#!/usr/bin/env bash
# effects.sh KILN FOLDER NAME: no option of a scene is without effect. Each override of NAME.txt must
# change the picture of FOLDER/NAME.yaml, in at least one value. "A given B" stands for an option A
# that shows only where B is set.
set -euo pipefail

kiln=$1 folder=$2 name=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work/cache

draw() {
    "$kiln" render "$folder/$name.yaml" --frames 40 --device cpu --quiet --force \
        -o "$work/$1.png" "${@:2}"
}

draw base
failed=0 count=0
while IFS= read -r row; do
    [[ -z $row || $row == '#'* ]] && continue
    count=$((count + 1))
    before=base given=()
    if [[ $row == *' given '* ]]; then
        before=given given=(--set "${row#* given }")
        draw given "${given[@]}" </dev/null
    fi
    draw changed "${given[@]}" --set "${row% given *}" </dev/null
    if "$kiln" compare --quiet --limit abs.max=0 "$work/$before.png" "$work/changed.png"; then
        echo "--set '$row' changes nothing" >&2
        failed=1
    fi
done <"$folder/$name.txt"
echo "$count overrides"
exit "$failed"
