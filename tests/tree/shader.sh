#!/usr/bin/env bash
# Checks that glslangValidator accepts every shader of a folder: shader.sh PRINTER OUT SHADERS FOLDER. If this
# fails, a driver may refuse a shader when kiln runs. A line "// variant: ..." in a shader file lists one set of
# defines with which kiln compiles the shader. Each variant is checked; of 20 variants or more, only every fourth,
# unless KILN_TESTS=all. PRINTER is the program shader_source, which prints a shader's complete text with its
# includes and defines. These texts stay in a folder of OUT that is named as the test, since the validator's messages
# give their line numbers.
set -euo pipefail
printer=$1 out=$2/${4//\//.} shaders=$3 folder=$4
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
