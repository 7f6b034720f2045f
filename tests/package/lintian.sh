#!/usr/bin/env bash
# Checks that lintian has no error or warning for the packages of WORK/release: lintian.sh WORK. The
# tag initial-upload-closes-no-bugs is suppressed: it is for uploads to Debian, and a release of
# kiln is none.
set -euo pipefail
cd "$1/release"
said=$(lintian --allow-root --fail-on error,warning --tag-display-limit 0 --suppress-tags initial-upload-closes-no-bugs ./*.deb 2>&1) || { echo "$said"; exit 1; }
echo "${said:-lintian has nothing to say}"
