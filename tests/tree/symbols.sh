#!/usr/bin/env bash
# Checks the compiled objects of lib/ in a build folder: symbols.sh BUILD. Each room (folder) of
# lib/ may use only symbols of rooms of a lower rank; rooms.awk lists the ranks, and the files that
# may use folders papers/. If this fails, a layer of the library uses a higher layer, or another
# layer of the same rank. includes.sh checks the same for headers, but does not see the use of a
# function that is declared in kiln.h, which every room may include.
set -euo pipefail
rooms=$(dirname "$(realpath "$0")")/rooms.awk
cd "$1"
mapfile -t objects < <(find CMakeFiles/kiln*.dir/lib -name '*.o' | sort)
if ((${#objects[@]} == 0)); then
    echo "no objects of lib/ under $1"
    exit 2
fi
nm --print-file-name --extern-only "${objects[@]}" | awk -f "$rooms" -f <(cat <<'AWK'
# A line of nm is "FILE:VALUE TYPE NAME". The value is blank if the symbol is undefined (type U).
{
    file = $1
    sub(/:.*/, "", file)
    sub(/^.*\/lib\//, "", file)
    name = $NF
    if ($(NF - 1) == "U") {
        uses[file SUBSEP name] = 1
    } else {
        defined[name] = file
    }
}
END {
    for (use in uses) {
        split(use, of, SUBSEP)
        if (!(of[2] in defined)) continue
        user = of[1]; definer = defined[of[2]]
        sub(/\.o$/, "", user); sub(/\.o$/, "", definer)
        if (!may_use("lib/" user, "lib/" definer)) {
            printf "lib/%s uses %s of lib/%s, which is in a folder papers/\n", of[1], of[2], defined[of[2]]
            failed = 1
        }
        from = room_of(of[1]); to = room_of(defined[of[2]])
        if (!may_read(from, to)) {
            printf "lib/%s uses %s of lib/%s, and %s does not read %s\n", of[1], of[2], defined[of[2]], from, to
            failed = 1
        }
    }
    exit failed
}
AWK
)
echo "the symbols keep the law"
