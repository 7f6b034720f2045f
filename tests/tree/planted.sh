#!/usr/bin/env bash
# Checks that the scripts for the rules of the source tree (includes.sh, symbols.sh, uniforms.sh,
# texts.sh, rows.sh, conversions.sh) find faults, and that option tables with faulty rows do not compile: planted.sh
# CC. If this fails, a source tree that breaks the rules passes the tests. The script breaks each
# rule once in a small tree, and the rule's script or the compiler must report it.
set -euo pipefail
compiler=$1
scripts=$(dirname "$(realpath "$0")")
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant: makes a small source tree that breaks no rule, and enters it.
plant() {
    rm -rf "${tree:?}"/*
    mkdir -p "$tree"/{cmd,decode,tests/unit,lib/{base,draw/{moment,light},sort/papers},shaders/{shared,draw/light}}
    cd "$tree"
    : >lib/kiln.h
    : >lib/base/error.h
    : >lib/draw/moment/view.h
    : >lib/draw/light/smoke.c
    : >lib/sort/keys.h
    : >lib/sort/papers/oddeven.h
    echo '#include "sort/papers/oddeven.h"' >lib/sort/sort.c
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
plant && echo '#include "sort/papers/oddeven.h"' >lib/sort/cpu.c
refused "a technique of the papers" '"sort/papers/oddeven.h" is for folders papers/ and lib/sort/sort.c' includes
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

rows() { "$scripts/rows.sh" "$tree"; }

plant && echo '{ROW(NO_PART, "size", pair, size, NULL, NULL)}, r->offset = 4' >lib/sort/keys.h
rows >/dev/null
plant && printf '\n{.name = "size", .type = &kiln_type_pair, .offset = AT(size)},\n' >lib/sort/keys.h
refused "a row with an offset" 'lib/sort/keys.h:2:{.name = "size", .type = &kiln_type_pair, .offset' rows

# row CC ROW: compiles an option table with this row, by the compiler CC and the headers of the
# source tree's lib/.
source=$(realpath "$scripts/../..")
row() {
    "$1" -std=c17 -Wall -Wextra -Wconversion -pedantic -Werror -fsyntax-only -I "$source/lib" -I "$source/shaders" \
        -x c - <<C
#include "option/rows.h"
enum shade { LIGHT, DARK };
struct lid { bool tight; };
struct bean { const char *name; double size_m; };
struct pot {
    double height_m;
    uint32_t handles, bean_count, size[2], other_count;
    bool full;
    enum shade shade;
    const char *label, *marks[3];
    struct lid lid;
    struct bean beans[4];
};
static const char *const shades[] = {"light", "dark", NULL};
#define FILLS struct lid
TABLE(lid) = {BOOLEAN(NO_PART, "tight", tight, "true", ""), END};
#undef FILLS
#define FILLS struct bean
TABLE(bean) = {{ROW(NO_PART, "size", number, size_m, "0", "")}, END};
ITEM(mark, text, LIMITS(KILN_PLAIN, 0, 9));
#undef FILLS
#define FILLS struct pot
TABLE(pot) = {BOOLEAN(NO_PART, "full", full, "true", ""), END};
KINDS(kinds) = {{.name = "pot", MEMBERS(pot)}, {.name = NULL}};
TABLE(rows) = {
    $2,
    END,
};
const void *tables(int i)
{
    const void *const all[] = {rows, lid, bean, pot, kinds, &mark, shades};
    return all[i];
}
C
}

# fits ROW: checks that all compilers accept the row. unfit ROW MESSAGE: checks that they refuse it
# with the message.
compilers=("$compiler")
if command -v clang >/dev/null; then compilers+=(clang); fi
fits() { for cc in "${compilers[@]}"; do row "$cc" "$1"; done; }
unfit() { for cc in "${compilers[@]}"; do refused "$1 by $cc" "$2" row "$cc" "$1"; done; }

fits '{ROW(NO_PART, "height", number, height_m, NULL, "")}'
unfit '{ROW(NO_PART, "height", integer, height_m, NULL, "")}' \
    'height_m is not of the C type that kiln_type_integer fills'
unfit '{ROW(NO_PART, "handles", number, handles, NULL, "")}' \
    'handles is not of the C type that kiln_type_number fills'
fits '{ROW(NO_PART, "size", pair, size, NULL, "")}'
unfit '{ROW(NO_PART, "size", pair, handles, NULL, "")}' \
    'handles is not of the C type that kiln_type_pair fills'
fits 'CHOICE(NO_PART, "shade", shade, shades, NULL, "")'
unfit 'CHOICE(NO_PART, "shade", full, shades, NULL, "")' \
    'full is not of the C type that kiln_type_choice fills'
fits 'GROUP_AT(NO_PART, "lid", lid, lid, "")'
unfit 'GROUP_AT(NO_PART, "lid", label, lid, "")' 'label is not of the struct that the table lid fills'
fits 'GROUP(NO_PART, "pot", pot, "")'
unfit 'GROUP(NO_PART, "pot", lid, "")' 'the table lid fills another struct'
fits 'SWITCH_AT(NO_PART, "lid", lid, lid, full, "none", "")'
unfit 'SWITCH_AT(NO_PART, "lid", lid, lid, shade, "none", "")' \
    'shade is not of the C type that kiln_type_boolean fills'
fits 'KIND(NO_PART, "kind", kinds, shade, NULL, "")'
unfit 'KIND(NO_PART, "kind", kinds, height_m, NULL, "")' \
    'height_m is not of the C type that kiln_type_choice fills'
fits 'LIST(NO_PART, "marks", marks, mark, other_count, "[]", "")'
unfit 'LIST(NO_PART, "marks", beans, mark, other_count, "[]", "")' \
    'beans is not an array of what mark fills'
unfit 'LIST(NO_PART, "marks", marks, mark, full, "[]", "")' \
    'full is not of the C type that kiln_type_integer fills'
fits 'MAP(NO_PART, "beans", beans, bean, bean_count, "{}", "")'
unfit 'MAP(NO_PART, "beans", marks, bean, bean_count, "{}", "")' \
    'marks is not an array of what bean fills'

texts() { "$scripts/texts.sh" "$tree"; }

plant
printf '    if (strstr(text, "an error"))\n    strstr(error.message, "no"); /* partly: why */\n' \
    >tests/unit/test_thing.c
printf '    "%%" PRIu64 "%%" PRIu32, a, b);\n    "%%" PRIu64\n    "%%" PRIu32, a, b);\n' >lib/sort/keys.h
texts >/dev/null

plant && echo '    assert_non_null(strstr(error->message, "no"));' >tests/unit/test_thing.c
refused "a part of a message" 'tests/unit/test_thing.c:1: looks for a part of a message' texts
plant && printf '    assert_true(strstr(\n        run.summary.message, "no"));\n' >tests/unit/test_thing.c
refused "a part of a message, on two lines" 'tests/unit/test_thing.c:2: looks for a part' texts
plant && echo '    strncmp(error.message, "no", 2);' >tests/unit/test_thing.c
refused "the start of a message" 'tests/unit/test_thing.c:1: looks for a part of a message' texts
plant && echo '    "%" PRIu64 "/%" PRIu64 PRIu64, a, b);' >lib/sort/keys.h
refused "two PRI macros" 'lib/sort/keys.h:1: two PRI macros in sequence' texts
plant && printf '    "%%" PRIu64\n\n    PRIx32, a);\n' >tests/unit/test_thing.c
refused "two PRI macros on two lines" 'tests/unit/test_thing.c:3: two PRI macros in sequence' texts

# conversions.sh gets a build that compiles one file of lib/draw, and the source tree's own headers.
convert() {
    printf '#include "shared/exact.h"\n%s\n' "$1" >lib/draw/light/lamp.c
    printf '[{"directory": "%s", "file": "%s/lib/draw/light/lamp.c", "command": "%s"}]\n' "$tree" "$tree" \
        "$compiler -Wall -I$tree/lib -I$tree/shaders -O2 -o lamp.o -c $tree/lib/draw/light/lamp.c" >compile_commands.json
}
conversions() { "$scripts/conversions.sh" "$tree" "$tree"; }

plant && cp "$source"/shaders/shared/{exact,elementary,platform}.h shaders/shared/
cast='lib/draw/light/lamp.c:2: a float is cast to an integer'
convert 'int f(float x) { return exact_int(x) + (int)exact_uint(x); }'
conversions >/dev/null
convert 'int f(float x) { return exact_int(x) + (int)x; }'
refused "a cast" "$cast" conversions
convert 'unsigned char f(double x) { return (unsigned char)(x + exact_int(1.0f)); }'
refused "a cast of a double" "$cast" conversions
convert 'int f(float x); int f(float x) { return exact_int(x) > 0 ? x : 0; }'
refused "a conversion without a cast" "$cast" conversions
convert '#define WHOLE(x) ((int)(x))
int f(float x) { return exact_int(x) + WHOLE(x); }'
refused "a cast in a macro" 'lib/draw/light/lamp.c:3: a float is cast' conversions
printf 'static inline int whole(float x) { return (int)x; }\n' >lib/draw/moment/view.h
convert '#include "draw/moment/view.h"
int f(float x) { return exact_int(x) + whole(x); }'
refused "a cast in a header" 'lib/draw/moment/view.h:1: a float is cast' conversions
convert 'this is not C'
refused "a file that does not compile" "unknown type name 'this'" conversions

# symbols.sh gets objects in which lib/base calls a function that lib/sort, a room (folder of lib/)
# above it, defines. includes.sh would miss this if kiln.h, which every room may include, declared
# the function.
objects=$tree/build/CMakeFiles/kiln_objects.dir/lib
compile() { "$compiler" -x c -c -o "$objects/$1.c.o" - <<<"$2"; }
mkdir -p "$objects"/{base,sort/papers}
compile base/error 'void kiln_error(void) {}'
compile sort/keys 'void kiln_error(void); void kiln_keys(void) { kiln_error(); }'
"$scripts/symbols.sh" "$tree/build" >/dev/null
compile base/error 'void kiln_keys(void); void kiln_error(void) { kiln_keys(); }'
refused "a symbol of a room above" 'lib/base/error.c.o uses kiln_keys of lib/sort/keys.c.o' \
    "$scripts/symbols.sh" "$tree/build"
compile base/error 'void kiln_error(void) {}'
compile sort/papers/oddeven 'void kiln_oddeven(void) {}'
compile sort/sort 'void kiln_oddeven(void); void kiln_sort(void) { kiln_oddeven(); }'
"$scripts/symbols.sh" "$tree/build" >/dev/null
compile sort/cpu 'void kiln_oddeven(void); void kiln_cpu(void) { kiln_oddeven(); }'
refused "a symbol of the papers" \
    'lib/sort/cpu.c.o uses kiln_oddeven of lib/sort/papers/oddeven.c.o, which is in a folder papers/' \
    "$scripts/symbols.sh" "$tree/build"
echo "every rule was seen to fail"
