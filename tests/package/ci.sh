#!/usr/bin/env bash
# Checks that the CI configurations of docs/ci/*.yml work in a new project: ci.sh SOURCE WORK. If
# this fails, a user who copies one gets a failing pipeline. The script runs their shell commands in
# a clean Debian 12, with the packages of WORK/release in place of the published ones.
set -euo pipefail
source=$1 work=$2
. "$(dirname "$0")/root.sh"
# parts FILE: prints the shell commands of a configuration, and its variables as exports.
parts() {
    python3 - "$1" <<'PYTHON'
import sys
import yaml

document = yaml.safe_load(open(sys.argv[1], encoding="utf-8"))
if "jobs" in document:
    steps = [step["run"] for step in document["jobs"]["golden"]["steps"] if "run" in step]
    variables = {**document.get("env", {}), **document["jobs"]["golden"].get("env", {})}
else:
    steps = document["golden"]["before_script"] + document["golden"]["script"] + document["golden"]["after_script"]
    variables = document["golden"].get("variables", {})
for name, value in variables.items():
    if not str(value).startswith("${{"):
        print(f"export {name}={value}")
print("\n".join(steps))
PYTHON
}
version=$(sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
for file in "$source"/docs/ci/*.yml; do
    root=$work/ci
    make_root "$root"
    mkdir -p "$root/releases/v$version" "$root/project/effects"
    cp "$work"/release/* "$root/releases/v$version/"
    cp "$source/scenes/fire_beam.yaml" "$root/project/effects/"
    {
        printf 'set -e\nexport KILN_RELEASES=file:///releases GITHUB_STEP_SUMMARY=/project/summary.md\ncd /project\n'
        # The project has no golden pictures yet. They are made by the command of docs/testing.md.
        parts "$file" | sed 's/^\(.*\)kiln test effects /kiln test effects --update missing --quiet || true\n&/'
    } >"$root/project/ci.sh"
    grep -q "kiln test effects" "$root/project/ci.sh" || fail "$file runs no test"
    inside "$root" bash /project/ci.sh >"$root/said" 2>&1 || { tail -n 20 "$root/said"; fail "$file fails"; }
    grep -q "pass  *fire_beam\|1 pass" "$root/said" || { tail -n 20 "$root/said"; fail "$file: nothing passed"; }
    [[ -s $root/project/out/junit.xml ]] || fail "$file: no JUnit report"
    if [[ $file == *github* ]]; then
        grep -q "fire_beam" "$root/project/summary.md" || fail "$file: the job's summary names no test"
    fi
    echo "${file##*/}: $(grep -c . "$root/project/ci.sh") lines ran"
    rm -rf "$root"
done
