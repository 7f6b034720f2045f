#!/usr/bin/env bash
# Runs Python code with the module `kiln` of a build: run.sh MODULE LIBRARY CC FOLDER runs the tests
# of the folder by pytest, and run.sh MODULE LIBRARY CC SCRIPT ARGUMENT... runs a script. MODULE is
# the folder of the module, LIBRARY the shared library that it is to use. The exit code is 77
# (skipped) if a Debian package is missing.
set -euo pipefail
# Debian's python3 comes first in PATH, since it has Debian's packages.
export PATH=/usr/bin:$PATH PYTHONPATH=$1 KILN_LIBRARY=$2 CC=$3 PYTHONDONTWRITEBYTECODE=1
what=$4
for module in cffi numpy pytest; do
    if ! /usr/bin/python3 -c "import $module" 2>/dev/null; then
        echo "skipped: python3-$module is missing; tools/setup installs it"
        exit 77
    fi
done
if [[ ! -f $1/kiln/_abi.py ]]; then
    echo "skipped: the Python module was not built; tools/setup installs what it takes, then configure again"
    exit 77
fi
if [[ -d $what ]]; then
    exec /usr/bin/python3 -m pytest -q -p no:cacheprovider "$what"
fi
exec /usr/bin/python3 "${@:4}"
