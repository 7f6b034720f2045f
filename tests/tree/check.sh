#!/usr/bin/env bash
# Checks that tools/check, which developers run before a commit, passes a small correct source tree
# and names each fault that is planted in it: check.sh SOURCE CC. If this fails, a fault is found
# only after the commit, when all tests run.
set -euo pipefail
source=$1 compiler=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{.ci,cmd,decode,examples,python,lib/base,tools,tests/tree,shaders/shared,cmake,build/release}
cp "$source"/tools/check "$tree/tools/"
cp "$source"/tests/tree/* "$tree/tests/tree/"
cp "$source"/.clang-format "$source"/.clang-tidy "$tree/"
cd "$tree"
echo "tools/demo tools/test" >README.md
echo "/build/" >.gitignore
: >CMakeLists.txt
printf 'int kiln_sum(int a, int b);\n' >lib/base/sum.h
printf '#include "base/sum.h"\n\nint kiln_sum(int a, int b)\n{\n    return a + b;\n}\n' >lib/base/sum.c
printf '[{"directory": "%s", "file": "lib/base/sum.c", "command": "%s -Wall -Ilib -c lib/base/sum.c"}]\n' \
    "$tree" "$compiler" >build/release/compile_commands.json
git init -q
git add -A
git -c user.name=kiln -c user.email=kiln@localhost commit -qm "a tree that is well"

# said NAME STATUS TEXT [ARGUMENT...]: runs tools/check with the arguments, fails unless it exits
# with STATUS and prints TEXT, and then restores the tree.
said() {
    local name=$1 expected=$2 text=$3 printed status=0
    shift 3
    printed=$(tools/check "$@" 2>&1) || status=$?
    if ((status != expected)) || [[ $printed != *"$text"* ]]; then
        printf '%s: exit %d, said\n%s\nand not: %s\n' "$name" "$status" "$printed" "$text"
        exit 1
    fi
    git checkout -q .
    git clean -qf
}

said "all is well" 0 "0 C files of the change and 0 unit tests of its rooms: all well"
mkdir -p tests/unit build/sanitize/tests
printf '#include "base/sum.h"\n\nint main(void)\n{\n    return kiln_sum(1, -1);\n}\n' >tests/unit/test_sum.c
printf '#!/bin/sh\nmkdir -p "$2/tests"\nprintf "#!/bin/sh\\necho a leak\\nexit 1\\n" >"$2/tests/$3"\nchmod +x "$2/tests/$3"\n' \
    >tests/tree/sanitize.sh
said "a test that fails with the sanitizers" 1 "unit.sum fails with the sanitizers:"
printf '\nint kiln_sum(int a,  int b);\n' >>lib/base/sum.h
said "a format" 1 "refused: format"
printf '#include "draw/picture.h"\n' >lib/base/sum.h
said "an include" 1 'lib/base/sum.h:1: "draw/picture.h" is not a header of lib/'
printf 'void kiln_sum(void)\n{\n    glUniform1i(0, 1);\n}\n' >lib/base/sum.c
said "a uniform" 1 "refused: uniforms"
printf '/* "%%" PRIu64 PRIu64 */\n' >lib/base/sum.h
said "a message" 1 "refused: texts"
printf '/* Long. */\n%.0s' {1..601} >lib/base/sum.h
said "a size" 1 "refused: sizes"
printf '#!/bin/sh\n' >tools/new
said "a script" 1 "refused: scripts"
printf 'int kiln_sum(int first, int second);\n' >lib/base/sum.h
said "a header, seen through its own file" 1 "readability-inconsistent-declaration-parameter-name"
printf '#include "base/sum.h"\n\nint kiln_sum(int a, int b)\n{\n    int unused;\n    return a + b;\n}\n' \
    >lib/base/sum.c
said "a warning of clang" 1 "clang-diagnostic-unused-variable"
rm -r build/release
printf '\n/* More. */\n' >>lib/base/sum.h
said "a tree that cannot be configured" 1 "build/release cannot be configured"
said "no commit" 2 "'nothing' is not a commit" nothing
echo "tools/check refuses what it should"
