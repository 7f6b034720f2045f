#!/usr/bin/env bash
# Checks the Debian packages in a clean Debian 12: install.sh SOURCE WORK KILN. If this fails, kiln
# does not work for users of the packages, or cannot be upgraded or removed. The packages are
# installed, used, upgraded from an older version, removed and purged; no file may be left behind.
set -euo pipefail
source=$1 work=$2 kiln=$3
. "$(dirname "$0")/root.sh"
root=$work/user
make_root "$root"
version=$(sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
mkdir -p "$root/release" "$root/older"

# Packages of an older version are made of the same files with a smaller version number.
for package in "$work/release"/*.deb; do
    dpkg-deb -R "$package" "$root/older/tree"
    sed -i "s/^Version: .*/Version: 0.1.9-1/; s/(= [^)]*)/(= 0.1.9-1)/; s/(>= $version)/(>= 0.1.9)/" \
        "$root/older/tree/DEBIAN/control"
    dpkg-deb --root-owner-group -b "$root/older/tree" "$root/release/$(basename "${package/_$version-1_/_0.1.9-1_}")" >/dev/null
    rm -r "$root/older/tree"
    cp "$package" "$root/release/"
done
names=(kiln libkiln0 libkiln-dev python3-kiln kiln-examples)
# files VERSION NAME...: prints the files of packages.
files() {
    local name
    for name in "${@:2}"; do
        (cd "$root/release" && printf './%s\n' "$name"_"$1"-1_*.deb)
    done
}
# list: prints the files of the root that packages may leave behind.
list() { (cd "$root" && find etc usr var/lib -xdev -type f -not -path 'var/lib/apt/*' -not -path 'var/lib/dpkg/*' \
    -not -path '*/__pycache__/*' | sort); }
# said CODE PATTERN COMMAND: runs a command in the root; checks its exit code and last line of
# output.
said() {
    local code=0 text
    text=$(inside "$root" sh -c "$3" 2>&1 | tr '\r' '\n' | tail -n 1; exit "${PIPESTATUS[0]}") || code=$?
    [[ $code == "$1" && $text =~ $2 ]] || fail "$3: exit code $code: $text"
}

# A newcomer installs the program alone. Pictures work; a video fails with a message that names the
# missing package.
list >"$work/before"
mapfile -t packages < <(files "$version" kiln kiln-examples)
apt_install "$root" "${packages[@]}"
said 0 "^kiln $version \([0-9a-f]{7}\)\$" "kiln --version"
said 0 "^kiln: 1" "kiln check /usr/share/kiln/scenes/fire_beam.yaml | head -n 1"
said 0 "" "kiln render /usr/share/kiln/scenes/fire_beam.yaml -o /tmp/beam.png --frames 40 --size 320x180 -q"
said 6 "libav.*cannot be loaded; install Debian's package" \
    "kiln render /usr/share/kiln/scenes/fire_beam.yaml -o /tmp/beam.mp4 --frames 0-3 --size 320x180 -q"

# With the recommended packages everything works, and the pixels are those of the build KILN.
apt_install "$root" libavcodec59 libavformat59 libavutil57 libswscale6 libjansson4 libjpeg62-turbo \
    liblcms2-2 libtiff6 libwebp7 libwebpdemux2 libseccomp2 man-db
said 0 "" "kiln render /usr/share/kiln/scenes/campfire.yaml -o /tmp/fire.mp4 --frames 0-9 --size 320x180 -q"
said 0 "" "kiln render /usr/share/kiln/scenes/campfire.yaml -o /tmp/fire.png --frames 9 --size 320x180 -q"
said 0 "sandbox: " "kiln devices --verbose | grep sandbox || kiln devices | grep sandbox"
"$kiln" render "$source/scenes/campfire.yaml" -o "$work/fire.png" --frames 9 --size 320x180 --device cpu -q --force
"$kiln" compare "$work/fire.png" "$root/tmp/fire.png" --quiet ||
    fail "the package draws another picture than the tree's build"
said 0 "^/usr/share/man/man5/kiln-scene.5" "man -w 5 kiln-scene"

# The library is used from C, C++ and Python.
mapfile -t packages < <(files "$version" libkiln0 libkiln-dev python3-kiln)
apt_install "$root" "${packages[@]}" gcc g++ cmake ninja-build pkg-config
said 0 "" "cmake -S /usr/share/kiln/examples -B /tmp/examples -G Ninja"
said 0 "" "cmake --build /tmp/examples"
said 0 "^frame 3, its brightest value is" "/tmp/examples/picture /usr/share/kiln/scenes/fire_beam.yaml 3 /tmp/a.ppm"
scene=/tmp/effect.yaml
said 0 "" "kiln new $scene && sed -i 's/frames: [0-9]*/frames: 12/' $scene"
said 0 "" "/tmp/examples/loop $scene /tmp/loop.mp4"
said 0 "" "/tmp/examples/film $scene /tmp/film.mp4 output.size=[192,108]"
said 0 "" "/tmp/examples/compare /tmp/fire.png /tmp/fire.png flip.mean=0.02"
said 0 "" "cd /tmp && python3 /usr/share/kiln/examples/poster.py $scene /tmp/poster.png output.size=[192,108]"
for made in loop.mp4 film.mp4 poster.png; do
    [[ -s $root/tmp/$made ]] || fail "an example left no $made"
done
said 0 "^[0-9]+ [0-9]+\$" \
    "python3 -c 'import kiln; scene = kiln.load(\"/usr/share/kiln/scenes/fire_beam.yaml\"); print(scene.info.width, scene.info.height)'"
said 0 "" "gcc -x c - -o /tmp/static \$(pkg-config --static --cflags --libs kiln | sed s/-lkiln/-l:libkiln.a/) <<'C'
#include <kiln.h>
int main(void) { return kiln_version()[0] == 0; }
C"

# The packages are upgraded from the older version, removed and purged.
inside "$root" apt-get -q -y purge "${names[@]}" >/dev/null 2>&1
mapfile -t older < <(files 0.1.9 "${names[@]}")
mapfile -t newer < <(files "$version" "${names[@]}")
apt_install "$root" "${older[@]}"
[[ $(inside "$root" dpkg-query -W -f '${Version}' kiln) == 0.1.9-1 ]] || fail "the older version is not installed"
apt_install "$root" "${newer[@]}"
for name in "${names[@]}"; do
    [[ $(inside "$root" dpkg-query -W -f '${Version}' "$name") == "$version-1" ]] || fail "$name was not upgraded"
done
said 0 "^kiln $version " "kiln --version"
inside "$root" apt-get -q -y remove "${names[@]}" >/dev/null 2>&1
said 127 "not found" "kiln --version"
# dpkg purges here, since apt does not know packages that no archive has.
inside "$root" dpkg --purge "${names[@]}" >/dev/null 2>&1
list >"$work/after"
left=$(comm -13 "$work/before" "$work/after" | grep -i kiln || true)
[[ -z $left ]] || fail "left behind: $left"
echo "installed, used, upgraded, removed and purged"
rm -rf "$root"
