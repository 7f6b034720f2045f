#!/usr/bin/env bash
# The JSON schema judged by ajv: ajv.sh SCENE_TEXT SOURCE.
set -euo pipefail
scene_text=$1
source=$2

. "$source/tests/support/packages.sh"
needs_packages "$source" ajv yaml
exec node "$source/tests/schema/ajv.mjs" "$scene_text" "$source"
