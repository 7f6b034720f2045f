#!/usr/bin/env bash
# Runs something with the Python module of a build: run.sh MODULE LIBRARY CC FOLDER, whose tests pytest
# runs, or SCRIPT ARGUMENT..., a script of Python. Exit code 77: a package of Debian is missing.
set -euo pipefail
# Debian's python3 comes first, whatever else the machine has.
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
