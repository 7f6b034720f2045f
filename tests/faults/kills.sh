#!/usr/bin/env bash
# kills.sh KILN SCENE OUTPUT KILLS SIGNAL [OPTION...]: a job that is killed at so many random points and
# gone on with ends with the bytes of one that nobody disturbed. After each kill only whole files stand
# under their names: an image is one of the undisturbed run's, a clip is there only when it is whole.
# OUTPUT is a pattern of images or the name of a clip; RANDOM_SEED=N repeats a run.
set -euo pipefail

kiln=$1 scene=$(realpath "$2") output=$3 kills=$4 signal=$5
shift 5
seed=${RANDOM_SEED:-$$}
RANDOM=$seed
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/calm" "$work/killed"

fail() {
    echo "$output, $signal, RANDOM_SEED=$seed: $1" >&2
    exit 1
}

render() {
    "$kiln" render "$scene" -q --device cpu -o "$@"
}

start=$(date +%s%N)
(cd "$work/calm" && render "$output" --manifest m.json "$@")
length_ms=$((($(date +%s%N) - start) / 1000000 + 1))

# Files without the notes of a job that is under way.
results() {
    find "$1" -type f ! -name '*.journal' ! -name '*.part' ! -name '.*.tmp' ! -name m.json -printf '%P\n' | sort
}

# What stands under final names is what it is in the undisturbed run; all of it, where it is told so.
compare() {
    while read -r file; do
        cmp -s "$work/calm/$file" "$work/killed/$file" || fail "$file is not whole after $after ms"
    done < <(results "$work/killed")
    [[ $1 == all ]] || return 0
    [[ $(results "$work/calm") == "$(results "$work/killed")" ]] || fail "other files"
    for folder in calm killed; do
        jq .result "$work/$folder/m.json" >"$work/$folder.result"
    done
    cmp -s "$work/calm.result" "$work/killed.result" || fail "another result in the manifest"
    left=$(find "$work/killed" -name '.*.tmp' -o -name '*.parts' -o -name '*.part')
    [[ -z $left ]] || fail "left behind: $left"
}

tried=0 after=0 wholes=0
while ((tried < kills || wholes == 0)); do
    code=0
    if ((tried < kills)); then
        after=$((RANDOM % (length_ms + length_ms / 4) + 5))
    else
        after=600000 # the last one is left alone
    fi
    {
        (cd "$work/killed" &&
            timeout --preserve-status -s "$signal" "$(printf '%d.%03d' $((after / 1000)) $((after % 1000)))" \
                "$kiln" render "$scene" -q --device cpu -o "$output" --manifest m.json --resume "$@") \
            2>"$work/messages" || code=$?
    } 2>/dev/null # where the shell says that something was killed
    case $signal:$code in
    *:0)
        compare all
        wholes=$((wholes + 1))
        ((tried >= kills)) || rm -rf "$work/killed" && mkdir -p "$work/killed" # and from the start again
        ;;
    KILL:137 | TERM:143 | INT:130)
        tried=$((tried + 1))
        wholes=0
        compare some
        [[ $signal == KILL || -z $(find "$work/killed" -name '.*.tmp') ]] ||
            fail "something half-written is left after $after ms"
        ;;
    *) fail "exit code $code after $after ms: $(cat "$work/messages")" ;;
    esac
done
echo "$output: $tried times $signal, the same in the end"
