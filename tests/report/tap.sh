#!/usr/bin/env bash
# Checks the TAP report by Perl's `prove`, and its YAML blocks by the npm package yaml: tap.sh
# WRITE_REPORTS SOURCE. If this fails, programs that read TAP refuse the report or count wrongly.
set -euo pipefail
write_reports=$1
if ! command -v prove >/dev/null; then
    echo "skipped: TAP is read by Perl's prove, and there is none"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# expect RUN STATUS LINE...: checks the exit code of `prove` for the report of a run, and that it
# prints the lines.
expect() {
    local run=$1 expected=$2 status=0 said
    shift 2
    mkdir -p "$work/$run"
    "$write_reports" "$run" "$work/$run" || true
    said=$(prove --exec cat "$work/$run/tap" 2>&1) || status=$?
    if ((status != expected)); then
        echo "$run: prove exits with $status, not $expected: $said"
        exit 1
    fi
    for line; do
        if ! grep -qxF "$line" <<<"$said"; then
            echo "$run: prove does not say '$line': $said"
            exit 1
        fi
    done
    # `prove` prints "Parse errors" for lines and versions of TAP that it does not understand.
    if grep -qi 'parse error' <<<"$said"; then
        echo "$run: $said"
        exit 1
    fi
}
expect good 0 "All tests successful." "Result: PASS"
expect bad 1 "  Failed tests:  1-2, 6-9" "Result: FAIL"

# `prove` must refuse a report with more tests than it plans, or it would accept anything.
sed 's/^1\.\.10/1..9/' "$work/bad/tap" >"$work/cut"
said=$(prove --exec cat "$work/cut" 2>&1) || true
if [[ $said != *"Parse errors: Bad plan"* ]]; then
    echo "prove takes anything"
    exit 1
fi

. "$2/tests/support/packages.sh"
needs_packages "$2" yaml
node "$2/tests/report/tap.mjs" "$work/bad/tap"
