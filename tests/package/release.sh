#!/usr/bin/env bash
# tools/release in a clean root: release.sh SOURCE WORK. A Debian 12 of its own has what tools/setup installs
# and a clone of the last commit; what comes out lies in WORK/release.
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

# What it refuses.
expect() { # the words, a command in the tree
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
# SPDX: each package with its checksum, each file once, nothing that points nowhere.
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
