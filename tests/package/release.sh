#!/usr/bin/env bash
# Checks that tools/release makes the packages, checksums and SPDX document of a release: release.sh
# SOURCE WORK. If this fails, no release can be made from a clean clone. tools/release runs in a
# fresh Debian 12 with the packages that tools/setup installs and a clone of the last commit. Its
# files are left in WORK/release.
set -euo pipefail
source=$1 work=$2
mkdir -p "$work"
. "$(dirname "$0")/root.sh"
root=$work/builder
[[ -z $(git -C "$source" status --porcelain) ]] || fail "commit first: a release is of a commit"
make_root "$root"
mapfile -t packages < <("$source/tools/setup" --list release)
mkdir -p "$root/release"
apt_install "$root" "${packages[@]}"
git clone -q --no-local "file://$source" "$root/src"
code=0
inside "$root" /src/tools/release >"$work/release.log" 2>&1 || code=$?
cat "$work/release.log"
((code == 0)) || exit 1
rm -rf "$work/release"
mv "$root/src/out/release" "$work/release"

# tools/release must refuse uncommitted changes, and an output folder with other files.
# expect TEXT COMMAND: checks that a command in the clone fails and prints the text.
expect() {
    local said code=0
    said=$(inside "$root" sh -c "cd /src && $2" 2>&1) || code=$?
    [[ $code == 1 && $said == *"$1"* ]] || fail "$2: exit code $code: $said"
}
expect "changes that are not committed" "touch new && tools/release; code=\$?; rm new; exit \$code"
expect "is no release" "mkdir -p out/other && touch out/other/mine && tools/release out/other"
rm -rf "$root"
cd "$work/release"
for package in kiln libkiln0 libkiln-dev python3-kiln kiln-examples; do
    files=("$package"_*.deb)
    [[ -f ${files[0]} ]] || fail "there is no package $package"
done
sha256sum --quiet --check SHA256SUMS
# The SPDX document must have each of the five packages with its checksum, no identifier twice, and
# no relationship to an unknown identifier.
jq -e --arg count 5 '
    [.packages[].SPDXID, .files[].SPDXID, .SPDXID] as $ids
    | ($ids | length) == ($ids | unique | length)
    and all(.relationships[]; [.spdxElementId, .relatedSpdxElement] - $ids == [])
    and ([.packages[] | select(.packageFileName)] | length) == ($count | tonumber)' \
    kiln-*.spdx.json >/dev/null || fail "the SPDX document does not hold together"
for package in *.deb; do
    sum=$(sha256sum "$package" | cut -d' ' -f1)
    jq -e --arg sum "$sum" 'any(.packages[].checksums[]?; .checksumValue == $sum)' kiln-*.spdx.json >/dev/null ||
        fail "the SPDX document has another checksum of $package"
done
