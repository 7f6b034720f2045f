#!/usr/bin/env bash
# Each variable of the environment that the tree reads has a row in `kiln help environment`, and each
# row is of a variable that is named in the tree. A name that is no literal at its getenv is one of a
# table, and stands in a file that is listed here.
set -euo pipefail
cd "$1"
kiln=$2
tables="cmd/shard.c"
callers="cmd/shard.c cmd/render.c" # of names out of the tables
failed=0

sources() { find cmd lib decode -name '*.[ch]' -not -path cmd/environment.c; }

# Names at the calls themselves, and in the tables.
read_names()
{
    sources | xargs grep -ohE '\b(secure_)?getenv\("[^"]*"\)' | sed 's/.*("//; s/").*//'
    grep -ohE '"[A-Z]+(_[A-Z]+)+"' $tables | tr -d '"'
}

while IFS=: read -r file line text; do
    if ! grep -qw "$file" <<<"$callers"; then
        echo "$file:$line: reads a variable whose name is no literal:$text"
        failed=1
    fi
done < <(sources | xargs grep -nE '\b(secure_)?getenv\([^")]')

said=$("$kiln" help environment | sed -nE 's/^  ([A-Z_0-9]+)$/\1/p' | sort -u)
found=$(read_names | sort -u)
for name in $(comm -13 <(echo "$said") <(echo "$found")); do
    echo "$name is read, but 'kiln help environment' does not say so; its row belongs in cmd/environment.c"
    failed=1
done
for name in $said; do
    if ! sources | xargs grep -q "\"$name\""; then
        echo "$name has a row in cmd/environment.c, but nothing reads it"
        failed=1
    fi
done
[ "$(wc -w <<<"$said")" -ge 10 ] || { echo "kiln help environment: too few rows could be read"; failed=1; }
exit $failed
