#!/usr/bin/env bash
# Runs ajv.mjs, which checks by the validator ajv that the JSON schema of scenes accepts correct
# scenes and refuses wrong ones: ajv.sh SCENE_TEXT SOURCE. If this fails, an editor marks correct
# scenes as wrong, or misses mistakes.
set -euo pipefail
scene_text=$1
source=$2

. "$source/tests/support/packages.sh"
needs_packages "$source" ajv yaml
exec node "$source/tests/schema/ajv.mjs" "$scene_text" "$source"
