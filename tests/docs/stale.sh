#!/usr/bin/env bash
# Checks that `kiln figure --check` finds figures that are stale, changed or missing: stale.sh KILN
# SOURCE. If this fails, a document may show a figure that its scene no longer gives. Of the tree's
# own figures only one is checked here, since `kiln figure --check docs`, which checks all, takes
# long.
set -euo pipefail
kiln=$(realpath "$1")
source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# expect CODE LINE COMMAND...: checks the exit code of a command, and that it prints the line.
expect() {
    local code=0
    said=$("${@:3}" 2>&1) || code=$?
    if [ "$code" != "$1" ] || ! grep -qxF -- "$2" <<<"$said"; then
        printf '%s\nexit code %s; expected %s and the line "%s"\n' "$said" "$code" "$1" "$2"
        exit 1
    fi
}

cp -r "$source/tests/cli/scenes" "$work/"
cd "$work"
"$kiln" figure sheet scenes/tiny.yaml -o docs/a/seeds.png --sweep seed=1,2
"$kiln" figure strip scenes/tiny.yaml -o docs/strip.pdf --count 2
cp -r docs/a/seeds.png before.png
cd /
expect 0 "$work/docs/a/seeds.png: up to date" "$kiln" figure --check "$work/docs"
sed -i 's/fov: 45/fov: 40/' "$work/scenes/tiny.yaml"
expect 1 "$work/docs/a/seeds.png: stale: the scene has changed in 'seed = 1'" \
    "$kiln" figure --check "$work/docs"
cmp "$work/before.png" "$work/docs/a/seeds.png" # a check writes nothing
cd "$work"
"$kiln" figure sheet scenes/tiny.yaml -o docs/a/seeds.png --sweep seed=1,2 --force
"$kiln" figure strip scenes/tiny.yaml -o docs/strip.pdf --count 2 --force
expect 0 "docs/strip.pdf: up to date" "$kiln" figure --check docs
printf x >>docs/strip.pdf
expect 1 "docs/strip.pdf: stale: the file is not the one that was written together with its sidecar" \
    "$kiln" figure --check docs
rm docs/strip.pdf
expect 1 "docs/strip.pdf: stale: the figure is missing" "$kiln" figure --check docs
# The other figures must be checked although one sidecar is broken.
printf '{"kiln_figure": 2}' >docs/a/broken.png.figure.json
expect 3 "docs/a/seeds.png: up to date" "$kiln" figure --check docs
# One figure of the tree must be up to date.
expect 0 "" "$kiln" figure --check "$source/docs/images/figures/billboards.jpg.figure.json" --quiet
