#!/usr/bin/env bash
# Checks that includes.sh, symbols.sh and uniforms.sh find faults: planted.sh CC. If this fails, one
# of them passes a tree that breaks its rules. In a small tree, each rule is broken once, and the
# script must name the place.
set -euo pipefail
compiler=$1
scripts=$(dirname "$(realpath "$0")")
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant: makes a small tree that breaks no rule.
plant() {
    rm -rf "${tree:?}"/*
    mkdir -p "$tree"/{cmd,decode,tests,lib/{base,draw/{moment,light},sort},shaders/{shared,draw/light}}
    cd "$tree"
    : >lib/kiln.h
    : >lib/base/error.h
    : >lib/draw/moment/view.h
    : >lib/draw/light/smoke.c
    : >lib/sort/keys.h
    : >shaders/shared/exact.h
    : >shaders/draw/light/smoke_blur.frag
    echo '#include "kiln.h"' >cmd/main.c
    printf '#include "base/error.h"\n#include "draw/moment/view.h"\n#include "shared/exact.h"\n' \
        >lib/draw/light/lamp.c
}

# refused NAME MESSAGE COMMAND...: checks that the command fails and prints the message.
refused() {
    local name=$1 message=$2 said status=0
    shift 2
    said=$("$@" 2>&1) || status=$?
    if ((status == 0)) || [[ $said != *"$message"* ]]; then
        printf '%s: exit %d, said\n%s\nand not: %s\n' "$name" "$status" "$said" "$message"
        exit 1
    fi
}

includes() { "$scripts/includes.sh" "$tree"; }

plant
includes >/dev/null

plant && echo '#include "draw/light/lamp.h"' >lib/base/error.h
refused "a room above" 'base includes "draw/light/lamp.h" of draw/light' includes
plant && echo '#include "draw/light/lamp.h"' >lib/draw/moment/view.h
refused "a later room of draw" 'draw/moment includes "draw/light/lamp.h" of draw/light' includes
plant && echo '#include "sort/keys.h"' >lib/draw/light/lamp.c
refused "a stage of the same rank" 'draw/light includes "sort/keys.h" of sort' includes
plant && echo '#include "base/error.h"' >cmd/main.c
refused "the program past kiln.h" 'cmd/ includes "base/error.h"' includes
plant && echo '#include <png.h>' >cmd/main.c
refused "the program past libc" 'cmd/ includes <png.h>' includes
plant && echo '#include "base/error.h"' >shaders/shared/exact.h
refused "what C and GLSL share" 'shaders/shared includes "base/error.h"' includes
plant && echo '/* Loose. */' >lib/loose.c
refused "a loose file" 'lib/loose.c:1: the root of lib/' includes
plant && mkdir lib/new && echo '/* New. */' >lib/new/thing.c
refused "an unknown room" 'lib/new/thing.c:1: a folder that the include law does not know' includes
plant && echo '/* Flat. */' >lib/draw/flat.c
refused "a file beside the rooms of draw" 'lib/draw/flat.c:1: a folder that' includes
plant && echo '/* Blurs. */' >shaders/draw/light/other.frag
refused "a shader of no C file" 'shaders/draw/light/other.frag:1: no C file' includes

uniforms() { "$scripts/uniforms.sh" "$tree"; }

plant
echo 'void f(void) { glUniform1ui(SIM_AT_USED, 3); glUniform1i(f->unit, 0); }' >lib/draw/light/smoke.c
echo 'layout(location = SIM_AT_USED) uniform uint used; layout(location = 0) out vec4 color;' \
    >shaders/draw/light/smoke_blur.frag
uniforms >/dev/null

plant && printf 'void f(void)\n{\n    glUniform1ui(3, used);\n}\n' >lib/draw/light/smoke.c
refused "a bare location" 'lib/draw/light/smoke.c:3: a uniform is set at a bare number' uniforms
plant && printf 'void f(void)\n{\n    glUniform2f(\n        0, a, b);\n}\n' >lib/draw/light/smoke.c
refused "a bare location in the next line" 'lib/draw/light/smoke.c:3: a uniform is set at' uniforms
plant && echo 'void f(GLuint p) { glProgramUniform1i(p, 2, 1); }' >lib/draw/light/smoke.c
refused "a bare location of a program" 'lib/draw/light/smoke.c:1: a uniform is set at' uniforms
plant && printf '\nlayout(location = 3) uniform uint used;\n' >shaders/draw/light/smoke_blur.frag
refused "a bare location in a shader" \
    'shaders/draw/light/smoke_blur.frag:2: the location of a uniform is a bare number' uniforms
plant && echo 'layout(location=1, binding = 2)uniform sampler2D smoke;' >shaders/draw/light/smoke_blur.frag
refused "a bare location beside a binding" \
    'shaders/draw/light/smoke_blur.frag:1: the location of a uniform is a bare number' uniforms

# symbols.sh is given objects in which lib/base calls a function that lib/sort defines. includes.sh
# would not find that when the function is declared in kiln.h, which every room may include.
objects=$tree/build/CMakeFiles/kiln_objects.dir/lib
compile() { "$compiler" -x c -c -o "$objects/$1.c.o" - <<<"$2"; }
mkdir -p "$objects"/{base,sort}
compile base/error 'void kiln_error(void) {}'
compile sort/keys 'void kiln_error(void); void kiln_keys(void) { kiln_error(); }'
"$scripts/symbols.sh" "$tree/build" >/dev/null
compile base/error 'void kiln_keys(void); void kiln_error(void) { kiln_keys(); }'
refused "a symbol of a room above" 'lib/base/error.c.o uses kiln_keys of lib/sort/keys.c.o' \
    "$scripts/symbols.sh" "$tree/build"
echo "every rule was seen to fail"
