#!/usr/bin/env bash
# Checks that the binary interface (ABI) of libkiln.so is the committed one, libkiln.abi: abi.sh
# SOURCE LIBRARY [--update]. If this fails, programs that were built with an older library may crash
# with the new one. An addition fails, too, although it breaks no program, until --update writes the
# file. docs/versions.md says which version and soname a change needs.
set -euo pipefail
source=$1 library=$2
committed=$source/tests/abi/libkiln.abi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/include"
cp "$source"/lib/kiln{,_compare,_job,_limits,_params,_sandbox}.h "$folder/include"
abidw --headers-dir "$folder/include" --drop-private-types --exported-interfaces-only --no-corpus-path \
    --no-comp-dir-path --no-show-locs --no-elf-needed --no-parameter-names --type-id-style hash \
    --out-file "$folder/found.abi" "$library"
sed -i "s,$(realpath "$source")/,," "$folder/found.abi"

mapfile -t exported < <(nm -D --defined-only "$library" | sed -nE 's/.* T (kiln_[a-z_]*).*/\1/p')
for function in "${exported[@]}"; do
    grep -q "<function-decl name='$function'" "$folder/found.abi" ||
        { echo "$function has no debug information: name its file in CMakeLists.txt"; exit 1; }
done
if [[ ${3:-} == --update ]]; then
    cp "$folder/found.abi" "$committed"
    exit
fi
code=0
abidiff "$committed" "$folder/found.abi" || code=$?
# abidiff's exit code has bits: 1 and 2 are its own errors, 4 is a change, 8 is a change that
# certainly breaks programs.
((code == 0)) || { echo "the interface changed: $0 $source $library --update, and docs/versions.md"; exit 1; }

# abidiff must see two planted changes that break programs: an enum constant with another value, and
# a function that is missing.
for planted in "s/name='KILN_READER_GONE' value='9'/name='KILN_READER_GONE' value='19'/" \
    "/elf-symbol name='kiln_render'/d"; do
    sed "$planted" "$folder/found.abi" >"$folder/broken.abi"
    ! cmp -s "$folder/found.abi" "$folder/broken.abi" || { echo "nothing is planted by $planted"; exit 1; }
    ! abidiff "$committed" "$folder/broken.abi" >/dev/null || { echo "abidiff does not see $planted"; exit 1; }
done
echo "${#exported[@]} functions, as committed"
