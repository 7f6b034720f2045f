#!/usr/bin/env bash
# Checks that each override of FOLDER/NAME.txt changes the picture of FOLDER/NAME.yaml in at least
# one value: effects.sh KILN FOLDER NAME [NUMBER/COUNT]. If this fails, an option is read but not
# used. tests/unit/test_motion.c does the same for options that move particles. A row "A given B"
# means that override A is compared with the scene in which B is set, since A alone has no effect.
# With 2/3, the script checks every third row from the second on.
set -euo pipefail

kiln=$1 folder=$2 name=$3 part=${4:-1/1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work/cache

draw() {
    "$kiln" render "$folder/$name.yaml" --frames 40 --device cpu --quiet -o "$1" "${@:2}" </dev/null
}

# draw_given OVERRIDE [--set OVERRIDE]: draws the scene with an override B of "A given B". Many rows
# have the same B, which is drawn once.
declare -A drawn=()
draw_given() {
    local picture=$work/given_${#drawn[@]}.png
    draw "$picture" "${@:2}"
    drawn[$1]=$picture
}

draw_given base
mkdir "$work/before" "$work/after"
number=${part%/*} step=${part#*/}
row_number=0 rows=()
while IFS= read -r row; do
    [[ -z $row || $row == '#'* ]] && continue
    row_number=$((row_number + 1))
    (((row_number - number) % step == 0)) || continue
    key=base given=()
    if [[ $row == *' given '* ]]; then
        key=${row#* given } given=(--set "${row#* given }")
        [[ -n ${drawn[$key]:-} ]] || draw_given "$key" "${given[@]}"
    fi
    draw "$work/after/${#rows[@]}.png" "${given[@]}" --set "${row% given *}"
    ln "${drawn[$key]}" "$work/before/${#rows[@]}.png"
    rows+=("$row")
done <"$folder/$name.txt"
((${#rows[@]} > 0))

# The limit 0 gives equal pictures the verdict "same". `kiln compare` exits with 1 if some differ.
status=0
"$kiln" compare --json --tolerance abs.max=0 "$work/before" "$work/after" >"$work/pairs" || status=$?
compared=$(jq 'select(.event == "result").counts | .same + .different' "$work/pairs")
if ((status > 1)) || [[ $compared != "${#rows[@]}" ]]; then
    echo "kiln compare: exit $status, $compared of ${#rows[@]} pictures" >&2
    exit 2
fi
failed=0
while read -r unchanged; do
    echo "--set '${rows[${unchanged%.png}]}' changes nothing" >&2
    failed=1
done < <(jq -r 'select(.event == "frame" and .verdict == "same").name' "$work/pairs")
echo "${#rows[@]} overrides"
exit "$failed"
