#!/usr/bin/env bash
# Checks that glslangValidator accepts the shaders of a folder: shader.sh PRINTER OUT SHADERS FOLDER. If this
# fails, a driver may refuse a shader when kiln runs. A shader is checked with each set of defines that its file
# lists in a line "// variant: ..."; if it lists 20 sets or more, only every fourth is checked, unless
# KILN_TESTS=all. PRINTER is the program shader_source, which prints a shader with its includes and defines. The
# texts are kept in OUT/FOLDER, since the validator's messages name their line numbers.
set -euo pipefail
printer=$1 out=$2/$4 shaders=$3 folder=$4
rm -rf "$out"
mkdir -p "$out"
for path in "$shaders/$folder"/*.{comp,vert,geom,frag}; do
    [[ -f $path ]] || continue
    file=${path##*/}
    mapfile -t variants < <(sed -n 's|^// variant: *||p' "$path")
    ((${#variants[@]} > 0)) || variants=("")
    step=1
    [[ ${KILN_TESTS:-} == all ]] || ((${#variants[@]} < 20)) || step=4
    for ((i = 0; i < ${#variants[@]}; i += step)); do
        read -ra defines <<<"${variants[i]}"
        "$printer" "$folder/$file" "${defines[@]}" >"$out/${file%.*}.$i.${file##*.}"
    done
done
shopt -s nullglob
cd "$out"
texts=(*)
echo "${#texts[@]} texts in $out"
exec glslangValidator "${texts[@]}"
