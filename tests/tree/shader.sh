#!/usr/bin/env bash
# Checks that glslangValidator accepts a shader of shaders/ with some defines: shader.sh PRINTER OUT
# FILE [NAME=VALUE]... If this fails, a driver may refuse the shader when kiln runs. PRINTER is the
# program shader_source, which prints the shader with its includes and defines. The text is kept in
# OUT, since the validator's messages have its line numbers.
set -euo pipefail
printer=$1 out=$2 file=$3
shift 2
mkdir -p "$(dirname "$out")"
"$printer" "$@" >"$out"
if ! glslangValidator "$out"; then
    echo "shaders/$file: invalid, with '${*:2}'; the lines above are those of $out" >&2
    exit 1
fi
