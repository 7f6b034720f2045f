#!/usr/bin/env bash
# An installed kiln stands alone: install.sh BUILD CC. Installs to a temporary prefix, runs the
# program from /, and builds a user of the library through pkg-config.
set -euo pipefail
build=$1 cc=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix" >/dev/null
libdir=$(dirname "$(find "$prefix" -name kiln.pc | head -n 1)")

for file in bin/kiln include/kiln.h; do
    [[ -f $prefix/$file ]] || { echo "$file is not installed"; exit 1; }
done
headers=$(find "$prefix/include" -type f | wc -l)
[[ $headers == 1 ]] || { echo "$headers headers are installed; kiln has one"; exit 1; }
[[ -f $prefix/share/kiln/scenes/fire_beam.yaml ]] || { echo "the scenes are not installed"; exit 1; }

(cd / && "$prefix/bin/kiln" help >"$prefix/help.txt")
grep -q render "$prefix/help.txt" || { echo "kiln help says nothing of render"; exit 1; }
(cd / && "$prefix/bin/kiln" check "$prefix/share/kiln/scenes/fire_beam.yaml" >/dev/null)

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
