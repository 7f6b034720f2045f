#!/usr/bin/env bash
# No room of lib/ uses what a room above it defines: symbols.sh BUILD. The law of includes cannot see
# that, since kiln.h, which every room may include, declares functions of all of them.
set -euo pipefail
rooms=$(dirname "$(realpath "$0")")/rooms.awk
cd "$1"
mapfile -t objects < <(find CMakeFiles/kiln*.dir/lib -name '*.o' | sort)
if ((${#objects[@]} == 0)); then
    echo "no objects of lib/ under $1"
    exit 2
fi
nm --print-file-name --extern-only "${objects[@]}" | awk -f "$rooms" -f <(cat <<'AWK'
# "FILE:VALUE TYPE NAME", the value blank where the name is undefined.
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
