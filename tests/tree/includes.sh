#!/usr/bin/env bash
# The include law of lib/ and cmd/: a file includes headers of its own room and of rooms to its left,
#     base < gpu < asset, particles < scene < sim, sort, draw, post, output, compare < frame < suite < report < figure < bench < cmd
# and cmd/ includes nothing of lib/ but kiln.h. shaders/shared is below all; kiln.h is for all, and so is
# what it includes.
set -euo pipefail
cd "$1"

find lib cmd shaders/shared -name '*.[ch]' | sort | xargs awk '
function rank_of(room) { return room in rank ? rank[room] : -1 }
function complain(text) { printf "%s:%d: %s\n", FILENAME, FNR, text; failed = 1 }
BEGIN {
    rank["base"] = 1; rank["gpu"] = 2; rank["asset"] = rank["particles"] = 3; rank["scene"] = 4
    rank["sim"] = rank["sort"] = rank["draw"] = rank["post"] = rank["output"] = rank["compare"] = 5
    rank["frame"] = 6; rank["suite"] = 7; rank["report"] = 8; rank["figure"] = 9; rank["bench"] = 10
    # What a program may take from the system: the C library, POSIX and what Linux adds to it.
    split("assert ctype errno fcntl float inttypes limits locale math poll pthread sched setjmp " \
          "signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib string strings " \
          "sys/file sys/ioctl sys/prctl sys/resource sys/stat sys/time sys/types sys/wait termios " \
          "time unistd", names, " ")
    for (i in names) libc[names[i] ".h"] = 1
}
FNR == 1 {
    count = split(FILENAME, part, "/")
    room = part[1] == "cmd" ? "cmd" : part[1] == "shaders" ? "shared" : count == 2 ? "frame" : part[2]
    if (part[1] == "lib" && rank_of(room) < 0) complain("a folder that the include law does not know")
}
/^[ \t]*#[ \t]*include/ {
    path = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*/, "", path)
    bracket = substr(path, 1, 1) == "<"
    sub(/^[<"]/, "", path); sub(/[>"].*$/, "", path)
    if (bracket) {
        if (room == "cmd" && !(path in libc)) complain("cmd/ includes <" path ">, not of libc")
        next
    }
    if ((path == "kiln.h" || path == "kiln_bench.h") && room != "shared") next
    slash = index(path, "/")
    target = slash ? substr(path, 1, slash - 1) : "frame"
    if (room == "cmd") {
        if (slash || system("test -f cmd/" path) != 0)
            complain("cmd/ includes \"" path "\", which is neither kiln.h nor of cmd/")
    } else if (target == "shared") {
        next
    } else if (room == "shared") {
        complain("shaders/shared includes \"" path "\"")
    } else if (rank_of(target) < 0) {
        complain("\"" path "\" is not a header of lib/")
    } else if (target != room && rank_of(target) >= rank_of(room)) {
        complain(room " includes \"" path "\" of " target)
    }
}
END { exit failed }'
echo "the includes keep the law"
