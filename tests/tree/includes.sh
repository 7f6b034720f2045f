#!/usr/bin/env bash
# Checks which headers the files of lib/, cmd/, decode/ and shaders/ include: includes.sh SOURCE. If
# this fails, the layers of the library depend on each other in a circle, or the program needs more
# than the public API. The folders of lib/ and shaders/ are called rooms; rooms.awk orders them.
#   lib/      may include headers of the same room, of rooms before it, of shaders/shared, and
#             lib/kiln*.h, the public headers
#   shaders/  as lib/; but shaders/shared includes only headers of its own
#   cmd/      may include lib/kiln*.h, its own headers and those of libc
#   decode/   may include lib/kiln*.h, its own headers and those of the rooms base and asset
# Headers in folders papers/ are included in such folders and in the files that rooms.awk lists. Only
# decode/draco_module.cc includes Draco, and only lib/base/ffmpeg.h includes FFmpeg. The name of a shader
# file begins with the name of a C file of the same room.
set -euo pipefail
rooms=$(dirname "$(realpath "$0")")/rooms.awk
cd "$1"

mapfile -t files < <(find lib cmd decode shaders -name '*.[ch]' -o -path 'shaders/*.*' -type f | sort -u)

awk -f "$rooms" -f - "${files[@]}" <<'AWK'
function complain(text) { printf "%s:%d: %s\n", FILENAME, FNR, text; failed = 1 }

# Returns the room of a file below lib/ or shaders/, and "" for a file in the root of lib/. For a
# file of cmd/, decode/ or shaders/shared, returns "cmd", "decode" or "shared".
function where(path) {
    if (path ~ /^cmd\//) return "cmd"
    if (path ~ /^decode\//) return "decode"
    if (path ~ /^shaders\/shared\//) return "shared"
    sub(/^(lib|shaders)\//, "", path)
    return room_of(path)
}

# Returns the files that may use a folder papers/, or "no other file".
function tables_of(path) {
    sub(/\/[^\/]*$/, "", path)
    return tables[path] ? tables[path] : "no other file"
}

# Returns whether a C file of lib/ belongs to a shader: its name is the shader's, or the start of
# the shader's name up to a "_". Suffixes like .frag, and _gl, _cpu or _simd at the end of the C
# file's name are ignored. So bloom_gl.c belongs to bloom_down.frag.
function has_file(path,    stem) {
    sub(/^shaders\//, "", path)
    sub(/\.[a-z]*$/, "", path)
    for (stem = path; stem != ""; ) {
        if (("lib/" stem) in stems) return 1
        if (!sub(/_[^_\/]*$/, "", stem)) return 0
    }
    return 0
}

BEGIN {
    # The system headers that cmd/ may include, those of C, POSIX and Linux.
    split("assert ctype errno fcntl float fnmatch inttypes limits locale math poll pthread sched setjmp " \
          "signal spawn stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib string strings " \
          "sys/file sys/ioctl sys/mman sys/prctl sys/resource sys/stat sys/time sys/types sys/wait termios " \
          "time unistd", names, " ")
    for (i in names) libc[names[i] ".h"] = 1
    for (i = 1; i < ARGC; i++) {
        stem = ARGV[i]
        if (stem !~ /^lib\/.*\.c$/) continue
        sub(/\.c$/, "", stem)
        stems[stem] = 1
        if (sub(/_(gl|cpu|simd)$/, "", stem)) stems[stem] = 1
    }
}
FNR == 1 {
    room = where(FILENAME)
    if (room == "" && FILENAME !~ /^lib\/kiln(_[a-z]*)?\.h$/)
        complain("the root of lib/ is for kiln.h and its parts alone")
    else if (room != "" && room != "cmd" && room != "decode" && room != "shared" && !is_room(room))
        complain("a folder that the include law does not know")
    if (FILENAME ~ /^shaders\/.*\.(comp|vert|frag|geom)$/ && !has_file(FILENAME))
        complain("no C file of its room has a name that this one begins with")
}
/^[ \t]*#[ \t]*include/ {
    path = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*/, "", path)
    bracket = substr(path, 1, 1) == "<"
    sub(/^[<"]/, "", path); sub(/[>"].*$/, "", path)
    if (bracket) {
        if (room == "cmd" && !(path in libc)) complain("cmd/ includes <" path ">, not of libc")
        if (path ~ /^lib(av|sw)/ && FILENAME != "lib/base/ffmpeg.h")
            complain("<" path "> is for lib/base/ffmpeg.h alone")
        if (path ~ /^draco/ && FILENAME != "decode/draco_module.cc")
            complain("<" path "> is for decode/draco_module.cc alone")
        next
    }
    if (path ~ /^kiln(_[a-z]+)?\.h$/ && room != "shared") next
    root = path ~ /^shared\// || path !~ /\.h$/ ? "shaders/" : "lib/"
    if (!may_use(FILENAME, root path)) complain("\"" path "\" is for folders papers/ and " tables_of(root path))
    target = path ~ /^shared\// ? "shared" : room_of(path)
    if (room == "cmd") {
        if (path != "commit.h" && (target != "" || system("test -f cmd/" path) != 0))
            complain("cmd/ includes \"" path "\", which is neither kiln_program.h nor of cmd/")
    } else if (room == "decode") {
        if (target != "base" && target !~ /^asset\// &&
            (target != "" || system("test -f decode/" path) != 0))
            complain("decode/ includes \"" path "\", which is not of base, asset or decode/")
    } else if (target == "shared") {
        next
    } else if (room == "shared") {
        complain("shaders/shared includes \"" path "\"")
    } else if (!is_room(target)) {
        complain("\"" path "\" is not a header of lib/")
    } else if (!may_read(room, target)) {
        complain(room " includes \"" path "\" of " target)
    }
}
END { exit failed }
AWK
echo "the includes keep the law"
