#!/usr/bin/env bash
# Checks that `kiln test` fails when kiln has a deliberate fault: mutation.sh KILN SOURCE NAME
# [--set KEY=VALUE | FILE EXPRESSION]...
#
# If this fails, the golden tests miss such a fault. The fault is an override of the scene, a sed
# expression on a shader, or in the program KILN itself. The golden test `fire_beam` must fail
# twice: with the hashes, and by the pictures alone. NAME `none` means that there is no fault, and
# the test must pass.
set -euo pipefail

kiln=$1 source=$2 name=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/fire_beam.test.yaml" <<TEST
kiln_test: 1
scene: $source/scenes/fire_beam.yaml
frames: [96]
size: [320, 180]
set:
  - seed=7
TEST
cp -r "$source/shaders" "$work/shaders"
while (($# >= 2)); do
    if [[ $1 == --set ]]; then
        echo "  - $2" >>"$work/fire_beam.test.yaml"
    else
        sed -i "$2" "$work/shaders/$1"
        if cmp -s "$work/shaders/$1" "$source/shaders/$1"; then
            echo "$name: the expression '$2' changes nothing in shaders/$1" >&2
            exit 2
        fi
    fi
    shift 2
done

expected=1
[[ $name == none ]] && expected=0
for judgement in "" --ignore-hashes; do
    # The step and the backdrop run in GL, so that a fault in a shader has an effect. Everything
    # else uses the plain vectors, the only ones for which a file *_simd.c with a fault is compiled.
    status=0
    KILN_SIMD=plain KILN_SHADER_DIR=$work/shaders "$kiln" test "$work/fire_beam.test.yaml" --asset-root / \
        --golden "$source/golden" --results "$work/results" --device software \
        --technique simulate=inplace,backdrop=gl --no-report $judgement || status=$?
    if ((status != expected)); then
        echo "$name: kiln test $judgement gave $status, not $expected" >&2
        exit 1
    fi
done
