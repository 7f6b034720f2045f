#!/usr/bin/env bash
# Checks that an installed kiln works without its source and build folders: install.sh BUILD CC. If
# this fails, kiln works for developers but not for users. The script installs kiln to a temporary
# prefix and runs the program from the folder /. It builds programs with the library by means of
# pkg-config and of CMake, builds and runs the examples, reads the manual pages, and completes
# command lines. It also checks that an installation with DESTDIR, which packagers use, has the same
# files.
set -euo pipefail
build=$1 cc=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix" >/dev/null
libdir=$(dirname "$(find "$prefix" -name kiln.pc | head -n 1)")

for file in bin/kiln include/kiln.h include/kiln_{compare,job,limits,sandbox}.h; do
    [[ -f $prefix/$file ]] || { echo "$file is not installed"; exit 1; }
done
headers=$(find "$prefix/include" -type f | wc -l)
[[ $headers == 6 ]] || { echo "$headers headers are installed; the library has six"; exit 1; }
for file in kiln/scenes/fire_beam.yaml kiln/scene.schema.json man/man1/kiln.1 man/man5/kiln-scene.5 \
    bash-completion/completions/kiln zsh/site-functions/_kiln fish/vendor_completions.d/kiln.fish; do
    [[ -f $prefix/share/$file ]] || { echo "share/$file is not installed"; exit 1; }
done
DESTDIR=$prefix/package cmake --install "$build" --prefix /usr >/dev/null
diff <(cd "$prefix" && find bin include share -type f | sort) \
    <(cd "$prefix/package/usr" && find bin include share -type f | sort)

(cd / && "$prefix/bin/kiln" help >"$prefix/help.txt")
grep -q render "$prefix/help.txt" || { echo "kiln help says nothing of render"; exit 1; }
# The scene campfire names pictures and the scene pot a mesh; the separate program kiln-decode must
# be found to read them.
for scene in fire_beam campfire pot; do
    (cd / && "$prefix/bin/kiln" check "$prefix/share/kiln/scenes/$scene.yaml" >/dev/null)
done
(cd / && "$prefix/bin/kiln" new "$prefix/effect.yaml" -q && "$prefix/bin/kiln" check -q "$prefix/effect.yaml")
modeline="# yaml-language-server: \$schema=$(realpath "$prefix")/share/kiln/scene.schema.json"
[[ $(head -n 1 "$prefix/effect.yaml") == "$modeline" ]] ||
    { echo "kiln new does not name the installed schema: $(head -n 1 "$prefix/effect.yaml")"; exit 1; }
[[ -x $prefix/libexec/kiln/kiln-decode ]] || { echo "kiln-decode is not installed"; exit 1; }

cat >"$prefix/user.c" <<'C'
#include <kiln.h>
#include <stdio.h>

int main(void)
{
    struct kiln_device_info info = kiln_device_info_empty();
    char advice[256];
    size_t count = kiln_device_list(&info, sizeof info, 1, advice);
    printf("kiln %s, %zu devices; %s\n", kiln_version(), count, advice);
    return 0;
}
C
export PKG_CONFIG_PATH=$libdir
version=$(pkg-config --modversion kiln)
# check_user HOW PROGRAM: checks that a program which was built in the way HOW prints the library
# version that kiln.pc has.
check_user() {
    said=$("$2")
    [[ $said == "kiln $version, "* ]] ||
        { echo "$1: the versions of the library and of kiln.pc differ: $said, $version"; exit 1; }
}
export LD_LIBRARY_PATH=${libdir%/pkgconfig}
read -ra flags <<<"$(pkg-config --cflags --libs kiln)"
"$cc" -Wall -Werror "$prefix/user.c" -o "$prefix/shared" "${flags[@]}"
[[ $(objdump -p "$prefix/shared") == *"NEEDED "*libkiln.so.0* ]] || { echo "the program needs no libkiln.so.0"; exit 1; }
check_user "pkg-config" "$prefix/shared"
read -ra flags <<<"$(pkg-config --static --cflags --libs kiln | sed 's/-lkiln/-l:libkiln.a/')"
"$cc" -Wall -Werror "$prefix/user.c" -o "$prefix/static" "${flags[@]}"
check_user "pkg-config --static" "$prefix/static"

mkdir "$prefix/project"
cp "$prefix/user.c" "$prefix/project"
cat >"$prefix/project/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.22)
project(user C)
find_package(kiln 0.2 REQUIRED)
add_executable(with_static user.c)
target_link_libraries(with_static kiln::kiln_static)
CMAKE
cmake -S "$prefix/project" -B "$prefix/built" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$prefix/built" >/dev/null
check_user "find_package, static" "$prefix/built/with_static"

# The examples are built and run from their installed sources, as a user would do.
examples=$prefix/share/kiln/examples
cmake -S "$examples" -B "$prefix/examples" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_FLAGS=-Werror -DCMAKE_CXX_FLAGS=-Werror >/dev/null
cmake --build "$prefix/examples" >/dev/null
# expect CODE PATTERN COMMAND...: checks the exit code of a command, and the last line of its output
# by a regular expression.
expect() {
    local code=0 text
    text=$(cd "$prefix/examples" && "${@:3}" 2>&1 | tr '\r' '\n' | tail -n 1; exit "${PIPESTATUS[0]}") || code=$?
    [[ $code == "$1" && $text =~ $2 ]] || { echo "${*:3}: exit code $code: $text"; exit 1; }
}
printf 'kiln: 1\noutput: {size: [48, 32], frames: 5}\nsystems: {a: {emit: {rate: 90}}}\n' >"$prefix/examples/small.yaml"
expect 0 '^frame 3, its brightest value is [0-9]+$' ./picture small.yaml 3 a.ppm
expect 0 '^frame 4, its brightest value is [0-9]+$' ./picture small.yaml 4 b.ppm
expect 2 'frames 9-9' ./picture small.yaml 9 c.ppm
expect 0 '^5 frames in ' ./loop small.yaml loop.mp4
expect 0 '^5 frames in ' ./film small.yaml film.mp4 systems.a.emit.rate=90
cmp "$prefix/examples/loop.mp4" "$prefix/examples/film.mp4"
expect 3 'unknown key' ./film small.yaml film.mp4 systems.a.emit.rat=90
expect 0 '^they look the same$' ./compare loop.mp4 film.mp4
expect 0 '^5 frames in ' ./film small.yaml other.mp4 systems.a.emit.rate=900 systems.a.look.size=1
expect 1 '^they look different$' ./compare loop.mp4 other.mp4

# The Python module is checked only if it was built: its files must be installed, the example that
# uses it must run, and pytest must find its plugin.
if [[ -f $build/python/kiln/_abi.py ]] && /usr/bin/python3 -c "import numpy, pytest" 2>/dev/null; then
    module=$(sed -n 's/^KILN_PYTHON_DIR:STRING=//p' "$build/CMakeCache.txt")
    diff <(cd "$prefix/$module" && find . -type f | sort) <(cd "$prefix/package/usr/$module" && find . -type f | sort)
    for file in "$build"/python/{kiln/*.py,kiln/py.typed,pytest_kiln.py,kiln-*.dist-info/*}; do
        cmp "$file" "$prefix/$module/${file#"$build"/python/}"
    done
    export PYTHONPATH=$prefix/$module PYTHONDONTWRITEBYTECODE=1
    expect 0 '^frame 3 of 5, [0-9]+ particles$' /usr/bin/python3 "$examples/poster.py" small.yaml poster.png
    expect 0 '^they look the same$' ./compare poster.png poster.png
    expect 3 'unknown key' /usr/bin/python3 "$examples/poster.py" small.yaml poster.png systems.a.emit.rat=90
    expect 2 '^usage: poster.py' /usr/bin/python3 "$examples/poster.py"
    (cd "$prefix" && /usr/bin/python3 -m pytest --fixtures -q -p no:cacheprovider 2>&1 || true) >"$prefix/fixtures.txt"
    grep -q '^assert_looks_like' "$prefix/fixtures.txt" || { echo "pytest does not find the plugin"; exit 1; }
else
    echo "the Python module was not looked at: tools/setup installs what it takes"
fi

tests=$(dirname "$(realpath "$0")")/..
"$tests/docs/man.sh" "$prefix/share/man/man1/kiln.1" "$prefix/share/man/man5/kiln-scene.5"
found=$(man -M "$prefix/share/man" -w 5 kiln-scene)
[[ $found == "$prefix/share/man/man5/kiln-scene.5" ]] || { echo "man finds kiln-scene in '$found'"; exit 1; }
"$tests/completion/press_tab.py" bash "$prefix/bin/kiln" "$prefix/share/bash-completion/completions/kiln"
"$tests/completion/press_tab.py" zsh "$prefix/bin/kiln" "$prefix/share/zsh/site-functions/_kiln"
"$tests/completion/press_tab.py" fish "$prefix/bin/kiln" "$prefix/share/fish/vendor_completions.d/kiln.fish"
