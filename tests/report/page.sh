#!/usr/bin/env bash
# Runs page.mjs, which checks the HTML report in Chromium: page.sh KILN MAKE_REPORT SOURCE OUT. If
# this fails, the report shows wrong results or does not work in a browser. The script makes reports
# of real runs, and by MAKE_REPORT one of 1000 tests. Screenshots of every view are left in OUT.
set -euo pipefail
kiln=$1
make_report=$2
source=$3
out=$4

. "$source/tests/support/packages.sh"
needs_packages "$source" playwright-core
export KILN_CHROMIUM=${KILN_CHROMIUM:-$(command -v chromium || true)}
if [[ -z $KILN_CHROMIUM ]]; then
    echo "skipped: there is no chromium (tools/setup installs it)"
    exit 77
fi
rm -rf "$out"
mkdir -p "$out/tests"/{effects,post,weather} "$out/many"
touch "$out/tests/.kiln-tests"
"$make_report" "$out/many" 1000 &
cp "$source/scenes/fire_beam.yaml" "$out/beam.yaml"
cd "$out"

# define NAME FRAMES [LINE]: writes a test of the scene.
define() {
    printf 'kiln_test: 1\nscene: ../../beam.yaml\nsize: [160, 90]\nframes: %s\n%s\n' \
        "$2" "${3:-}" >"tests/$1.test.yaml"
}
# run [OPTION...]: runs `kiln test`. Exit codes 1 and 3 are expected, since some tests are to fail.
run() {
    local code=0
    "$kiln" test --device software --quiet "$@" tests >log.txt 2>&1 || code=$?
    if ((code != 0 && code != 1 && code != 3)); then
        cat log.txt
        exit 1
    fi
}

# Four tests are accepted as they are.
define effects/fire_beam '"66-89"' 'about: The flame reaches the block and turns to smoke.'
define effects/linear '[66]' 'format: exr'
define post/bloom '[66, 67]'
define post/tonemap '[66, 67]'
run --update missing

# Then three of them change: fewer particles from a moment on, much more bloom, and a little more
# bloom. Three tests are new: one without a golden picture, one whose scene has a mistake, and one
# for a device that does not exist.
define effects/fire_beam '"66-89"' \
    'about: The flame reaches the block and turns to smoke.
set: ["systems.fire.emit.rate={keys: {2.2 s: 380, 2.5 s: 60}}"]'
define effects/linear '[66]' 'format: exr
set: [post.bloom.strength=2.5]'
define post/bloom '[66, 67]' 'set: [post.bloom.strength=0.162]'
define post/sparks '[66]'
define weather/storm '[66]' 'about: "</script><script>window.harmed=1</script><!--"
set: ["systems.<img src=x onerror=window.harmed=2>=1"]'
define weather/rain '[66]' 'devices: [no-such-device]'
run
"$kiln" test report --quiet --link --report linked.html out/test >log.txt 2>&1 || true
wait
exec node "$source/tests/report/page.mjs" "$out"
