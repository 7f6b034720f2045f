#!/usr/bin/env bash
# Compares kiln with three.js on many glTF files: proof.sh COMPARE NODES BUILD [FOLDER...]. COMPARE is
# the program of compare.c, and NODES that of nodes.c, whose files are written anew, too. The files are
# those of set/, written anew, those of Debian's assimp-testmodels, and those below the folders; files
# that gltf-validator refuses are left out, and the one of the set that kiln is to refuse. If this
# fails, kiln misreads a valid glTF file.
set -euo pipefail
cd "$(dirname "$0")"
compare=$1 nodes=$2 build=$3
shift 3

for command in node npm; do
    command -v "$command" >/dev/null || { echo "$command is missing; tools/setup test installs it" >&2; exit 1; }
done
[[ -d node_modules/three ]] || npm ci --no-audit --no-fund --loglevel=error
models=/usr/share/assimp/models/glTF2
[[ -d $models ]] || { echo "Debian's package assimp-testmodels is missing; tools/setup gltf installs it" >&2; exit 1; }

rm -rf "$build"
mkdir -p "$build/expected" "$build/nodes"
node nodes.mjs "$build/nodes"
"$nodes" "$build/nodes"
node make.mjs "$build/set"
mapfile -t files < <(find "$build/set" "$models" "$@" \( -iname '*.gltf' -o -iname '*.glb' \) \
    ! -name extension-of-nodes.gltf | sort)
EXPECT_VALID=1 node expect.mjs "${files[@]}" "$build/expected"
for file in "${files[@]}"; do
    [[ ! -f $build/expected/${file//\//_}.expect ]] || echo "$file any"
done >"$build/cases.txt"
"$compare" "$build/cases.txt" "$build/expected"
