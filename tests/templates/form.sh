#!/usr/bin/env bash
# Checks examples/templates in Chromium: form.sh KILN SOURCE OUT. The form must make the three files
# of values that lie beside it, and kiln must render the template with each. If this fails, a reader
# of docs/templates.md gets a form that makes wrong values. Screenshots are left in OUT.
set -euo pipefail
kiln=$1
source=$2
out=$3

. "$source/tests/support/packages.sh"
needs_packages "$source" playwright-core
export KILN_CHROMIUM=${KILN_CHROMIUM:-$(command -v chromium || true)}
if [[ -z $KILN_CHROMIUM ]]; then
    echo "skipped: there is no chromium (tools/setup installs it)"
    exit 77
fi
rm -rf "$out"
mkdir -p "$out"
cp "$source"/examples/templates/* "$out"
cd "$out"
"$kiln" params title.yaml --json >params.json
cat >all.yaml <<'END'
kiln: 1
params:
  tilt: {number: 5 deg, max: 90 deg, help: "<img src=x onerror=window.harmed=1>"}
  place: {vector: [0, 1 m, 2]}
  shade: {color: [0.5, 0.5, 0.5]}
  style: {choice: calm, of: [calm, wild]}
  title: {text: "\"quoted\" $$x"}
END
"$kiln" params all.yaml --json >all.json
node "$source/tests/templates/form.mjs" "$source" "$out"
for name in lower_third logo_sting counter; do
    "$kiln" render title.yaml --params "made_$name.json" -o "$name.png" -q --frames 40 --size 64x36 --device cpu
done
"$kiln" check -q all.yaml --params made_all.json
