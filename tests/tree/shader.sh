#!/usr/bin/env bash
# Validates one shader: shader.sh PRINTER OUT FILE [NAME=VALUE]... PRINTER is tests/tree/shader_source;
# the text that it prints is kept in OUT, whose lines the validator names.
set -euo pipefail
printer=$1 out=$2 file=$3
shift 2
mkdir -p "$(dirname "$out")"
"$printer" "$@" >"$out"
if ! glslangValidator "$out"; then
    echo "shaders/$file: invalid, with '${*:2}'; the lines above are those of $out" >&2
    exit 1
fi
