#!/usr/bin/env bash
# Checks that README.md names tools/demo and tools/test, the two commands with which a newcomer
# starts, and that every script has its executable bit: entrance.sh SOURCE. If this fails, a
# newcomer does not find the commands, or a script ends with "Permission denied".
set -euo pipefail
cd "$1"
failed=0
for command in tools/demo tools/test; do
    if ! grep -qF "$command" README.md; then
        echo "README.md does not name $command"
        failed=1
    fi
done
while IFS= read -r -d '' file; do
    if [[ ! -x $file ]] && head -c 2 "$file" | grep -q '^#!'; then
        echo "$file: a script without its executable bit"
        failed=1
    fi
done < <(find tools tests python examples .ci -type f -not -path '*/node_modules/*' -print0)
exit $failed
