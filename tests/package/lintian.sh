#!/usr/bin/env bash
# The packages under lintian: lintian.sh WORK. No error, no warning.
set -euo pipefail
cd "$1/release"
said=$(lintian --allow-root --fail-on error,warning --tag-display-limit 0 ./*.deb 2>&1) || { echo "$said"; exit 1; }
echo "${said:-lintian has nothing to say}"
