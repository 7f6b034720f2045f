#!/usr/bin/env bash
# Checks by the validator ajv that the events of every command follow their JSON schema: events.sh
# KILN SOURCE. If this fails, a program that reads `--events ndjson` by the schema breaks.
set -euo pipefail
kiln=$1 source=$2
. "$source/tests/support/packages.sh"
needs_packages "$source" ajv
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$source/tests/cli/scenes" "$work/scenes"
cd "$work"
tiny=scenes/tiny.yaml
run() { "$kiln" "$@" --events ndjson:events >/dev/null 2>&1 || true; }
run render $tiny -o a_%d.png --frames 0-2 --device cpu --stats
run render $tiny -o a.mp4 --resume --device cpu
run render $tiny -o b.mp4 --shard 1/1 --device cpu
run render $tiny -o none --frames 0 --device cpu
run render none.yaml -o a.png
run render $tiny $tiny -o a.mp4
run render $tiny -o a_%d.png --frames 0-2 --force --limits output=100
run bake $tiny -o states --every 10 --device cpu
run bake $tiny -o states --every 10 --device cpu --resume
# The states in the folder were saved with another seed, of which kiln warns.
run render $tiny -o none --frames 20 --states states --set seed=9 --device cpu
printf '{"scene": "%s", "output": "batch_%d.png", "frames": "0"}\n{"scene": "none.yaml", "output": "x.png"}\n' $tiny >jobs.ndjson
run render --batch jobs.ndjson --keep-going --device cpu
run export $tiny -o gas_%d.vdb --device cpu
printf 'kiln: 1\noutput: {frames: 2}\ngas: {fire: {box: {center: [0, 1, 0], size: [2, 2, 2]}, cells: 16}}\n' >gas.yaml
run export gas.yaml -o gas_%d.vdb --device cpu
run plan $tiny --device cpu
run join b.mp4
run encode a_%d.png -o c.mp4
run compare a_0.png a_1.png --stats
run compare a_0.png none.png
run check $tiny
printf 'kiln: 1\nparams: {a: {number: 1, min: 0}}\n' >params.yaml
run params params.yaml
run devices
run test scenes --golden golden
run test report out/test
run figure sheet $tiny -o sheet.png --frames 0
run new new.yaml
"$kiln" help events-schema >schema.json
exec node "$source/tests/schema/events.mjs" schema.json events
