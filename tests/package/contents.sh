#!/usr/bin/env bash
# Checks the file lists of the Debian packages against the files that `cmake --install` installs,
# and that all files name the same version of kiln: contents.sh SOURCE BUILD. If this fails, a
# package lacks a file, or two packages have the same. Each installed file must be in exactly one
# package; a list may also install a copy of it in another folder. Each line of a list must match a
# file.
set -euo pipefail
source=$1 build=$2
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
DESTDIR=$root cmake --install "$build" --prefix /usr >/dev/null
# Files are moved to the folders that packaging/debian/rules configures for helper programs and
# libraries.
mkdir -p "$root/usr/multiarch/libkiln0"
mv "$root/usr/libexec/kiln" "$root/usr/multiarch/libkiln0/"
[[ ! -d $root/usr/lib/python3 ]] || mv "$root/usr/lib/python3" "$root/usr/"
mv "$root"/usr/lib/* "$root/usr/multiarch/"
mv "$root/usr/multiarch" "$root/usr/lib/"
[[ ! -d $root/usr/python3 ]] || mv "$root/usr/python3" "$root/usr/lib/"
failed=0
cd "$root"
for list in "$source"/packaging/debian/*.install; do
    while read -r pattern folder; do
        found=$(compgen -G "$pattern" || true)
        [[ -n $found ]] || { echo "${list##*/}: nothing is installed as $pattern"; failed=1; continue; }
        while read -r path; do
            find "$path" \( -type f -o -type l \) >>"$([[ -z $folder ]] && echo claimed || echo elsewhere)"
        done <<<"$found"
    done <"$list"
done
find usr \( -type f -o -type l \) | sort >there
sort claimed | uniq -d | sed 's/^/in two packages: /' >wrong
comm -13 <(sort -u claimed elsewhere) there | sed 's/^/in no package: /' >>wrong
cat wrong
[[ ! -s wrong ]] || failed=1

version=$(sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
# says TEXT FILE: checks that a file of the tree has the text.
says() {
    grep -qF -- "$1" "$source/$2" || { echo "$2 does not say '$1'"; failed=1; }
}
says "#define KILN_VERSION \"$version\"" lib/kiln.h
says "kiln ($version-1)" packaging/debian/changelog
says "## $version" CHANGELOG.md
says "KILN_VERSION: $version" docs/ci/github.yml
says "KILN_VERSION: $version" docs/ci/gitlab.yml
says "kiln_$version-1_amd64.deb" README.md
says "libkiln0_$version-1_amd64.deb" docs/python.md
says "libkiln-dev_$version-1_amd64.deb" docs/library.md
((failed == 0)) && echo "$(wc -l <there) files, each in one package, all of version $version"
