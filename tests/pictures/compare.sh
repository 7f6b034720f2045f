#!/usr/bin/env bash
# Checks that kiln reads pictures as independent readers do: compare.sh KILN FOLDER. If this fails,
# kiln misreads a kind of picture, or no longer refuses one that it cannot show. FOLDER/cases.txt
# has a line for each picture:
#   PICTURE same REFERENCE MOST      no level differs by more than MOST from the reference
#   PICTURE differs REFERENCE        kiln tells it from the reference
#   PICTURE refused MESSAGE          kiln refuses it with this message
set -euo pipefail
kiln=$1 folder=$2

failed=0 count=0
complain() { echo "$1" >&2; failed=1; }

while read -r picture verdict what most; do
    [[ $picture && $picture != '#'* ]] || continue
    count=$((count + 1))
    case $verdict in
    same)
        "$kiln" compare --quiet --tolerance "abs.max=$most" "$folder/$what" "$folder/$picture" ||
            complain "$picture: kiln reads another picture than $what"
        ;;
    differs)
        status=0
        "$kiln" compare --quiet --tolerance abs.max=0 "$folder/$what" "$folder/$picture" || status=$?
        [[ $status == 1 ]] || complain "$picture: found exit code $status against $what, expected 1"
        ;;
    refused)
        message="$what${most:+ $most}" status=0
        found=$("$kiln" compare --quiet "$folder/$picture" "$folder/$picture" 2>&1) || status=$?
        [[ $status == 3 && $found == *"$picture: $message" ]] ||
            complain "$picture: found exit code $status and '$found', expected 3 and '$message'"
        ;;
    *)
        complain "$picture: cases.txt has no verdict '$verdict'"
        ;;
    esac
done <"$folder/cases.txt"
echo "$count pictures"
((count > 0)) || failed=1
exit "$failed"
