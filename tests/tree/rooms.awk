# Defines the order of the rooms (folders) of lib/ for includes.sh and symbols.sh, which check that
# no room depends on a later one. A room may use rooms with smaller ranks; rooms of the same rank
# may not use each other.
BEGIN {
    rank["base"] = 1; rank["option"] = 2; rank["gpu"] = 3
    rank["asset"] = rank["particles"] = 4; rank["scene"] = 5
    rank["sim"] = rank["sort"] = rank["draw"] = rank["post"] = rank["output"] = 6
    rank["compare"] = 7; rank["frame"] = 8; rank["job"] = 9; rank["suite"] = 10
    rank["report"] = 11; rank["figure"] = 12; rank["bench"] = 13
    rank["start"] = 14; rank["batch"] = 15

    # asset, sim and draw are divided: the folders inside of them are rooms, ranked within asset,
    # sim or draw.
    inner["asset/loader"] = 1; inner["asset/image"] = 2
    inner["asset/geometry"] = inner["asset/atlas"] = 3
    inner["sim/world"] = 1; inner["sim/crowd"] = inner["sim/gas"] = inner["sim/paint"] = 2
    inner["sim/step"] = 3
    inner["draw/vector"] = 1; inner["draw/moment"] = 2; inner["draw/light"] = 3
    inner["draw/backdrop"] = 4; inner["draw/solids"] = 5; inner["draw/volume"] = 6
    inner["draw/sprites"] = 7
    for (room in inner) divided[substr(room, 1, index(room, "/") - 1)] = 1

    # A room may have a folder papers/, with techniques that exist for comparison with the papers that describe
    # them. Of the files outside of such folders, only those below may use it, and they have its techniques as
    # rows of a table.
    tables["lib/asset/geometry/papers"] = "" # the folders papers/ of scene and sim/world use it
    tables["lib/scene/papers"] = "lib/scene/samples.c"
    tables["lib/bench/papers"] = "lib/bench/bench.c lib/bench/gravity.c"
    tables["lib/sim/crowd/papers"] = "lib/sim/crowd/interact.c"
    tables["lib/sim/step/papers"] = "lib/sim/step/simulate.c lib/sim/step/slots_touching.h"
    tables["lib/sim/world/papers"] = "lib/sim/world/grids.c"
    tables["lib/sort/papers"] = "lib/sort/sort.c"
    tables["shaders/shared/papers"] = "shaders/shared/collide_field.h"
}

# Returns the room of a path: "draw/light" for "draw/light/smoke.c", "base" for "base/error.h",
# "sort" for "sort/papers/oddeven.c", "" for "kiln.h".
function room_of(path) {
    if (!sub(/\/[^\/]*$/, "", path)) return ""
    sub(/\/papers$/, "", path)
    return path
}

# Returns whether a file may include headers, and call functions, of another one as far as folders
# papers/ go. Both are paths from the root of the tree.
function may_use(file, other) {
    if (other !~ /\/papers\/[^\/]*$/ || file ~ /\/papers\/[^\/]*$/) return 1
    sub(/\/[^\/]*$/, "", other)
    return index(" " tables[other] " ", " " file " ") > 0
}

function is_room(room) {
    return room in inner || (room in rank && !(room in divided))
}

# Returns whether files of a room may include headers, and call functions, of another room.
function may_read(room, other,    a, b) {
    split(room, a, "/")
    split(other, b, "/")
    if (a[1] != b[1])
        return rank[b[1]] < rank[a[1]]
    return room == other || inner[other] < inner[room]
}
