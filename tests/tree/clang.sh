#!/usr/bin/env bash
# Every file compiles without a warning with clang, too: clang.sh BUILD. The commands of the build,
# checking only; what gcc alone understands stays out.
set -euo pipefail
sed -n 's/^ *"command": "\(.*\)",$/\1/p' "$1/compile_commands.json" |
    sed -e 's/\\"/"/g' -e 's/\\\\/\\/g' -e 's/^[^ ]* /clang -fsyntax-only /' -e 's/ -o [^ ]*//' |
    (cd "$1" && xargs -d '\n' -n 1 -P 2 sh -c)
