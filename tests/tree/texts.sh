#!/usr/bin/env bash
# Checks how the code formats error messages, and how tests compare them: texts.sh SOURCE. If this
# fails, a message may have a typo that no test sees. A test must compare a message as a whole
# (tests/support/errors.h) instead of looking for a part of it. A line that must look for a part
# says why in a comment that starts with "partly:". Two PRI macros in sequence, such as PRIu32
# PRIu32, are forbidden in lib/, cmd/, decode/ and tests/, since printf prints the second as letters
# instead of a number.
set -euo pipefail
cd "$1"

mapfile -t files < <(find lib cmd decode tests -name '*.[ch]' -not -path '*/node_modules/*')

awk -f - "${files[@]}" <<'AWK'
function complain(text) { printf "%s:%d: %s\n", FILENAME, FNR, text; failed = 1 }

FNR == 1 { carried = "" }
{
    # Both rules hold across line breaks: `carried` is the unfinished end of the earlier lines.
    line = carried " " $0
    if (line ~ /(^|[^A-Za-z0-9_])PRI[A-Za-z0-9]+[ \t]+PRI[A-Za-z0-9]/)
        complain("two PRI macros in sequence")
    if (FILENAME ~ /^tests\// && line !~ /\/\* partly: / &&
        line ~ /(strstr|strncmp|memcmp|assert_memory_equal)\([ \t]*[A-Za-z0-9_.>[\]-]*(message|error)[,)]/)
        complain("looks for a part of a message; compare the whole one (tests/support/errors.h)")
    if (match(line, /(PRI[A-Za-z0-9]+|(strstr|strncmp|memcmp|assert_memory_equal)\()[ \t]*$/))
        carried = substr(line, RSTART)
    else if ($0 !~ /^[ \t]*$/)
        carried = ""
}
END { exit failed }
AWK
echo "messages are compared as a whole"
