#!/usr/bin/env bash
# Checks that the examples of docs/library.md work as its readers run them, with the library
# installed: library.sh BUILD [--update]. They are compiled by `cc` and by the compiler that CMake
# finds.
set -euo pipefail
build=$1
here=$(dirname "$(realpath "$0")")
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix" >/dev/null
library=$(dirname "$(find "$prefix" -name libkiln.so)")
export PKG_CONFIG_PATH=$library/pkgconfig LD_LIBRARY_PATH=$library CMAKE_PREFIX_PATH=$prefix
/usr/bin/python3 "$here/console.py" "${@:2}" "$prefix/bin/kiln" "$here/../../docs/library.md"
