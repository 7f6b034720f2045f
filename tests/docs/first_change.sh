#!/usr/bin/env bash
# The diff of CONTRIBUTING.md's first change still applies to the tree, without fuzz, or has been
# applied: first_change.sh SOURCE.
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
