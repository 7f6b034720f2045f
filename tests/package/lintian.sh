#!/usr/bin/env bash
# The packages under lintian: lintian.sh WORK. No error, no warning. One tag has no meaning here: the first upload
# to Debian closes the bug that asked for it, and a release of kiln is no upload.
set -euo pipefail
cd "$1/release"
said=$(lintian --allow-root --fail-on error,warning --tag-display-limit 0 --suppress-tags initial-upload-closes-no-bugs ./*.deb 2>&1) || { echo "$said"; exit 1; }
echo "${said:-lintian has nothing to say}"
