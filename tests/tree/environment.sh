#!/usr/bin/env bash
# Checks that `kiln help environment` has a row for each environment variable that kiln reads, and
# no other rows: environment.sh SOURCE KILN. If this fails, users do not learn of a variable that
# changes kiln's behaviour, or read of one that does nothing. The names are found as string literals
# in calls of getenv, and in the tables of a few files. Only the files that are listed below may
# have such tables or call getenv with another argument than a literal.
set -euo pipefail
cd "$1"
kiln=$2
tables="cmd/shard.c"
callers="cmd/shard.c cmd/render.c lib/base/environment.c" # files that call getenv with a name from a table
failed=0

sources() { find cmd lib decode -name '*.[ch]' -not -path cmd/environment.c; }

# read_names: prints the names of the variables that kiln reads: literals in calls of getenv, and
# entries of the tables.
read_names()
{
    sources | xargs grep -ohE '\b((secure_)?getenv|kiln_environment)\("[^"]*"\)' | sed 's/.*("//; s/").*//'
    grep -ohE '"[A-Z]+(_[A-Z]+)+"' $tables | tr -d '"'
}

while IFS=: read -r file line text; do
    if ! grep -qw "$file" <<<"$callers"; then
        echo "$file:$line: reads a variable whose name is no literal:$text"
        failed=1
    fi
done < <(sources | xargs grep -nE '\b((secure_)?getenv|kiln_environment)\([^")]' | grep -v 'kiln_environment(const char')

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
