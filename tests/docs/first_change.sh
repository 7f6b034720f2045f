#!/usr/bin/env bash
# Checks that the diff in CONTRIBUTING.md, "A first change in ten minutes", applies to the tree
# exactly, without fuzz, or has been applied: first_change.sh SOURCE. If this fails, the first thing
# that a newcomer tries does not work.
set -euo pipefail
cd "$1"
diff=$(sed -n "/^\`\`\`diff\$/,/^\`\`\`\$/p" CONTRIBUTING.md | sed "/^\`\`\`/d")
files=$(grep -c '^+++ b/' <<<"$diff") || { echo "CONTRIBUTING.md has no diff"; exit 1; }
try() { patch --dry-run --fuzz=0 --force -p1 "$@" <<<"$diff"; }
if ! said=$(try) && ! try --reverse >/dev/null; then
    echo "the first change of CONTRIBUTING.md does not apply any more:"
    echo "$said"
    exit 1
fi
echo "$files files of the first change"
