#!/usr/bin/env bash
# mutation.sh KILN SOURCE NAME [--set KEY=VALUE | FILE EXPRESSION]...
#
# Runs the golden test `fire_beam` with one deliberate fault, by an override of the scene or by a sed
# expression on a shader (or in KILN itself), and passes if `kiln test` fails, both with the hashes
# and by the pictures alone. With the name `none` there is no fault, and it must pass.
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
    # Techniques in GL, so that faults of the step and of the backdrop can be made in shaders; the
    # plain vectors, for which a file *_simd.c with a fault is compiled.
    status=0
    KILN_SIMD=plain KILN_SHADER_DIR=$work/shaders "$kiln" test "$work/fire_beam.test.yaml" --asset-root / \
        --golden "$source/golden" --results "$work/results" --device software \
        --technique simulate=inplace,backdrop=gl --no-report $judgement || status=$?
    if ((status != expected)); then
        echo "$name: kiln test $judgement gave $status, not $expected" >&2
        exit 1
    fi
done
