#!/usr/bin/env bash
# An installed kiln stands alone: install.sh BUILD CC. Installs to a temporary prefix, runs the
# program from /, builds a user of the library through pkg-config, shows the manual pages and has
# command lines completed. With DESTDIR everything lands below it, as packagers need it.
set -euo pipefail
build=$1 cc=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix" >/dev/null
libdir=$(dirname "$(find "$prefix" -name kiln.pc | head -n 1)")

for file in bin/kiln include/kiln.h include/kiln_{bench,figure,job,json,limits,sandbox,test}.h; do
    [[ -f $prefix/$file ]] || { echo "$file is not installed"; exit 1; }
done
headers=$(find "$prefix/include" -type f | wc -l)
[[ $headers == 8 ]] || { echo "$headers headers are installed; kiln has eight"; exit 1; }
for file in kiln/scenes/fire_beam.yaml kiln/scene.schema.json man/man1/kiln.1 man/man5/kiln-scene.5 \
    bash-completion/completions/kiln zsh/site-functions/_kiln; do
    [[ -f $prefix/share/$file ]] || { echo "share/$file is not installed"; exit 1; }
done
DESTDIR=$prefix/package cmake --install "$build" --prefix /usr >/dev/null
diff <(cd "$prefix" && find bin include share -type f | sort) \
    <(cd "$prefix/package/usr" && find bin include share -type f | sort)

(cd / && "$prefix/bin/kiln" help >"$prefix/help.txt")
grep -q render "$prefix/help.txt" || { echo "kiln help says nothing of render"; exit 1; }
for scene in fire_beam campfire pot; do # the latter have pictures and a mesh, which kiln-decode reads
    (cd / && "$prefix/bin/kiln" check "$prefix/share/kiln/scenes/$scene.yaml" >/dev/null)
done
[[ -x $prefix/libexec/kiln/kiln-decode ]] || { echo "kiln-decode is not installed"; exit 1; }

cat >"$prefix/user.c" <<'C'
#include <kiln.h>
#include <stdio.h>

int main(void)
{
    struct kiln_device_info info;
    char advice[256];
    size_t count = kiln_device_list(&info, 1, advice);
    printf("kiln %s, %zu devices; %s\n", KILN_VERSION, count, advice);
    return 0;
}
C
export PKG_CONFIG_PATH=$libdir
version=$(pkg-config --modversion kiln)
read -ra flags <<<"$(pkg-config --cflags --libs kiln)"
"$cc" -Wall -Werror "$prefix/user.c" -o "$prefix/user" "${flags[@]}"
said=$("$prefix/user")
echo "$said"
[[ $said == "kiln $version, "* ]] || { echo "the versions of kiln.h and kiln.pc differ: $version"; exit 1; }

tests=$(dirname "$(realpath "$0")")/..
"$tests/docs/man.sh" "$prefix/share/man/man1/kiln.1" "$prefix/share/man/man5/kiln-scene.5"
found=$(man -M "$prefix/share/man" -w 5 kiln-scene)
[[ $found == "$prefix/share/man/man5/kiln-scene.5" ]] || { echo "man finds kiln-scene in '$found'"; exit 1; }
"$tests/completion/press_tab.py" bash "$prefix/bin/kiln" "$prefix/share/bash-completion/completions/kiln"
"$tests/completion/press_tab.py" zsh "$prefix/bin/kiln" "$prefix/share/zsh/site-functions/_kiln"
