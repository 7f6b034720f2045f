#!/usr/bin/env bash
# Checks which packages tools/setup installs, and what it prints when it cannot install them:
# setup.sh SOURCE. If this fails, a newcomer's first command fails or installs the wrong packages.
# Stubs replace the system's programs: apt-get and npm only print their arguments, dpkg-query says
# that all packages but $ABSENT are installed, sudo fails, and node does nothing.
set -euo pipefail
machine=$(mktemp -d)
trap 'rm -rf "$machine"' EXIT
chmod 755 "$machine"
mkdir "$machine/bin" "$machine/tools"
cp "$1/tools/setup" "$machine/tools/"

stub() { printf '#!/bin/bash\n%s\n' "$2" >"$machine/bin/$1" && chmod 755 "$machine/bin/$1"; }
# shellcheck disable=SC2016
stub dpkg-query 'for p; do [[ $p != -* && $p != "$ABSENT" ]] && echo "installed $p"; done; true'
stub apt-get 'echo "apt-get $*"'
stub sudo 'exit 1'
stub npm 'echo "npm $*"'
stub node 'true'

# run NAME EXPECTED_STATUS COMMAND...: runs a command with the stubs, checks its exit status, and
# leaves its output in $said.
run() {
    local name=$1 expected=$2 status=0
    shift 2
    said=$(PATH="$machine/bin:$PATH" "$@" 2>&1 </dev/null) || status=$?
    if ((status != expected)); then
        echo "$name: exit $status, not $expected: $said"
        exit 1
    fi
}
# expect PATTERN: checks that the output which `run` left in $said matches the pattern.
expect() {
    if [[ $said != $1 ]]; then
        printf 'said:     %s\nexpected: %s\n' "$said" "$1"
        exit 1
    fi
}

export ABSENT=nothing
run "all is there" 0 "$machine/tools/setup" test
expect ""
run "a wrong word" 2 "$machine/tools/setup" everything
expect "usage: *"

unprivileged=()
if ((EUID == 0)); then
    export ABSENT=libfyaml-dev
    run "one is missing" 0 "$machine/tools/setup" demo
    expect "Installing 1 packages: libfyaml-dev
apt-get update -q
apt-get install -y -q --no-install-recommends libfyaml-dev"
    unprivileged=(setpriv --reuid=65534 --clear-groups)
fi
export ABSENT=libfyaml-dev
run "one is missing, without root" 1 "${unprivileged[@]}" "$machine/tools/setup" demo
expect "Packages are missing*
sudo apt-get update && sudo apt-get install -y libfyaml-dev"
export ABSENT=libcmocka-dev
run "the demo needs no tests" 0 "${unprivileged[@]}" "$machine/tools/setup" demo
expect ""

run "several names, the one of which is missing" 1 "${unprivileged[@]}" \
    "$machine/tools/setup" demo fuzz
expect "Packages are missing*apt-get install -y libcmocka-dev"
run "a wrong word after a right one" 2 "$machine/tools/setup" demo everything
expect "usage: *"

# If an optional package is missing, tools/setup succeeds and says what will not work.
export ABSENT=gnuplot-nox
run "an optional one is missing, without root" 0 "${unprivileged[@]}" "$machine/tools/setup" test
expect "gnuplot-nox is not there and not needed: *"
run "what is optional can be wanted" 1 "${unprivileged[@]}" "$machine/tools/setup" bench
expect "Packages are missing*apt-get install -y gnuplot-nox"
run "the demo needs nothing optional" 0 "${unprivileged[@]}" "$machine/tools/setup" demo
expect ""

# tools/setup installs the npm packages only when tests/node_modules is not up to date.
mkdir -p "$machine/tests/node_modules"
echo '{}' >"$machine/tests/package-lock.json"
export ABSENT=nothing
run "npm packages are missing" 0 "$machine/tools/setup"
expect "*npm ci --prefix tests*"
run "npm packages are there" 0 "$machine/tools/setup"
expect ""
