#!/usr/bin/env bash
# The JSON schema judged by ajv: ajv.sh SCENE_TEXT SOURCE.
set -euo pipefail
scene_text=$1
source=$2

for program in node npm; do
    if ! command -v "$program" >/dev/null; then
        echo "skipped: the schema is validated by npm's ajv, and there is no $program"
        exit 77
    fi
done
if [[ ! -d $source/tests/node_modules/ajv ]]; then
    npm ci --prefix "$source/tests" --no-audit --no-fund --loglevel=error
fi
exec node "$source/tests/schema/ajv.mjs" "$scene_text" "$source"
