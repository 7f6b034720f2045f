#!/usr/bin/env bash
# docs/library.md as its readers run it, with the library installed: library.sh BUILD [--update]. The compilers are
# `cc` and CMake's choice.
set -euo pipefail
build=$1
here=$(dirname "$(realpath "$0")")
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix" >/dev/null
library=$(dirname "$(find "$prefix" -name libkiln.so)")
export PKG_CONFIG_PATH=$library/pkgconfig LD_LIBRARY_PATH=$library CMAKE_PREFIX_PATH=$prefix
/usr/bin/python3 "$here/console.py" "${@:2}" "$prefix/bin/kiln" "$here/../../docs/library.md"
