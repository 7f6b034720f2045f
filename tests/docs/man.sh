#!/usr/bin/env bash
# Checks that groff and mandoc find no fault in the manual pages, and that `man` shows them whole:
# man.sh PAGE... If this fails, a reader of `man kiln` sees broken or missing text.
set -euo pipefail
for program in groff mandoc man; do
    command -v $program >/dev/null || { echo "$program is not installed; tools/setup installs it"; exit 1; }
done
failed=0
for page; do
    # mandoc's warning of a missing date is ignored: the pages have no date on purpose, so that each
    # build writes the same pages.
    said=$(groff -man -ww -z "$page" 2>&1; mandoc -Tlint -W warning "$page" | grep -v 'missing date' || true)
    if [[ $said ]]; then
        echo "$said"
        failed=1
    fi
    shown=$(MANWIDTH=80 LC_ALL=C.UTF-8 man -l "$page" | col -b)
    for heading in NAME DESCRIPTION "SEE ALSO"; do
        grep -qx "$heading" <<<"$shown" || { echo "$page: man shows no $heading"; failed=1; }
    done
    if (($(wc -l <<<"$shown") < 500)); then
        echo "$page: man shows only $(wc -l <<<"$shown") lines"
        failed=1
    fi
done
exit $failed
