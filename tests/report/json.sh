#!/usr/bin/env bash
# Checks the contents of the JSON report, as jq reads it: json.sh WRITE_REPORTS SOURCE. If this
# fails, programs that read the report get wrong values or miss members.
set -euo pipefail
write_reports=$1
if ! command -v jq >/dev/null; then
    echo "skipped: JSON is read by jq, and there is none"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for run in good bad; do
    mkdir "$work/$run"
    "$write_reports" "$run" "$work/$run" || true
done

# expect RUN FILTER VALUE: checks what a filter of jq gives for the report of a run, good or bad.
expect() {
    local found
    found=$(jq -c "$2" "$work/$1/json")
    if [[ $found != "$3" ]]; then
        echo "$1: $2 is $found, not $3"
        exit 1
    fi
}
expect good .kiln_report 1
expect good .code 0
expect good '[.total_s, .started]' '[12.3456,"2026-01-31T12:00:00Z"]'
expect bad .code 5
expect bad .counts '{"tests":10,"pass":1,"skip":1,"warn":1,"change":1,"new":1,"fail":2,"error":3}'
expect bad '[.tests[] | select(.status == "fail") | .name]' '["fail/metrics","fail/state"]'
expect bad '[.tests[].name] == ([.tests[].name] | sort)' true
# All tests have the same members, and so do all frames that were measured.
expect bad '[.tests[] | keys] | unique | length' 1
expect bad '[.tests[].frames[] | select(.measured) | keys] | unique | length' 1
expect bad '[.tests[].frames[] | select(.measured) | .metrics | keys_unsorted] | unique' \
    '[["flip.mean","ssim","psnr"]]'
expect bad '.tests[] | select(.name == "fail/metrics") | [.folder, .score, .frames[1].beyond]' \
    '["out/fail/metrics",2,["flip.mean"]]'
expect good '.tests[0].frames[1].metrics.psnr' null # infinite
expect bad '.tests[] | select(.name == "lost") | [.code, .test]' '[5,"tests/lost.test.yaml"]'
expect bad '.tests[0].message == "a&b<c>\"d'\''#e\\f%g:h,i]]>j{k}\u0001\u001b[31m\nl\tm\r\u00e9\ufffe"' \
    true
