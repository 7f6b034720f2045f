#!/usr/bin/env bash
# Checks that tests find the deliberate faults of tests/mutation/patches/NAME.patch: patches.sh
# check|run SOURCE BUILD COPY CTEST [NAME...]. A patch begins with sentences about its fault. Its
# line "Test:" names the test of CTest that must fail; of a test in parts, one part must fail. Its line "Says:" is a text that the test must
# print when it fails, so that a failure for another reason does not count.
#
# `check` checks, without a build, that every patch applies to SOURCE and that BUILD has its test.
# `run` clones SOURCE, with its uncommitted changes, to COPY and builds it. The tests must pass
# there without a fault. Then, for one patch after the other, `run` applies the patch, builds the
# test's program and runs the test, which must fail.
set -euo pipefail

action=$1 source=$(realpath "$2") build=$(realpath "$3") copy=$(realpath -m "$4") ctest=$5
shift 5
folder=$source/tests/mutation/patches

failed=0
wrong() {
    printf '%s: %s\n' "$1" "$2" >&2
    failed=1
}

names=("$@")
if ((${#names[@]} == 0)); then
    names=("$folder"/*.patch)
    names=("${names[@]##*/}")
    names=("${names[@]%.patch}")
fi

# GIT_DIR=/dev/null makes git take the paths of a patch relative to the working directory.
apply_patch() { (cd "$1" && GIT_DIR=/dev/null git apply "${@:2}" 2>&1); }

# cmocka prints this before the name of a test function that fails.
cmocka='[  FAILED  ] '

declare -A test_of says_of
check_patch() {
    local name=$1 patch=$folder/$1.patch line test="" says="" said
    if [[ ! -f $patch ]]; then
        wrong "$name" "there is no $patch"
        return
    fi
    while IFS= read -r line && [[ $line != 'diff '* ]]; do
        case $line in
            'Test: '*) test=${line#Test: } ;;
            'Says: '*) says=${line#Says: } ;;
        esac
    done <"$patch"
    test_of[$name]=$test says_of[$name]=$says
    said=$(apply_patch "$source" --check "$patch") || wrong "$name" "the patch does not apply: $said"
    grep -qE ": ${test//./[.]}([.][0-9]+)?\$" <<<"$listed" ||
        wrong "$name" "'Test: $test' is no test of CTest in $build"
    if [[ -z $says ]]; then
        wrong "$name" "the line 'Says:' is missing"
    elif [[ $says == "$cmocka"* ]]; then
        local program=$source/tests/${test/.//test_}.c function=${says#"$cmocka"}
        grep -qw "$function" "$program" || wrong "$name" "'$function' is not in $program"
    fi
}

listed=$("$ctest" --test-dir "$build" -N)
for name in "${names[@]}"; do
    check_patch "$name"
done
if ((failed > 0)) || [[ $action == check ]]; then
    echo "${#names[@]} patches"
    exit "$failed"
fi

# target TEST: prints the CMake target that a test needs.
target() {
    case $1 in
        unit.* | gpu.*) sed 's/[.]/_/' <<<"$1" ;;
        *) echo kiln_program ;;
    esac
}

mutant=$copy/build/release
build_for() {
    local test targets=()
    for test; do
        targets+=("$(target "$test")")
    done
    cmake --build "$mutant" --target "${targets[@]}" >"$mutant/patches.log" 2>&1 ||
        { cat "$mutant/patches.log" >&2; return 1; }
}

run_test() { "$ctest" --test-dir "$mutant" --output-on-failure -R "^${1//./[.]}([.][0-9]+)?\$" 2>&1; }

[[ -d $copy/.git ]] || git clone -q --shared --no-checkout "$source" "$copy"
exec 9<"$copy/.git/config"
if ! flock -n 9; then
    echo "$copy: another run has this copy" >&2
    exit 1
fi

# restore: takes all faults out of COPY, also those of a run that was stopped. `git reset` writes
# only the files that differ, so that little is built again.
commit=$(git -C "$source" -c user.name=kiln -c user.email=kiln@localhost stash create)
commit=${commit:-$(git -C "$source" rev-parse HEAD)}
restore() { git -C "$copy" reset -q --hard "$commit"; }
restore
(cd "$copy" && cmake --preset test -DKILN_ALL_TESTS=ON >/dev/null)

mapfile -t tests < <(printf '%s\n' "${test_of[@]}" | sort -u)
build_for "${tests[@]}"
for test in "${tests[@]}"; do
    said=$(run_test "$test") || wrong "$test" "fails without any fault: $said"
done
((failed == 0)) || exit 1

for name in "${names[@]}"; do
    test=${test_of[$name]} says=${says_of[$name]}
    apply_patch "$copy" "$folder/$name.patch"
    if ! build_for "$test"; then
        wrong "$name" "does not compile"
    elif said=$(run_test "$test"); then
        wrong "$name" "$test passes: no test sees the fault"
    elif ! found=$(grep -m 1 -B 2 -F -e "$says" <<<"$said"); then
        wrong "$name" "$test fails, and does not say '$says': $said"
    else
        reason=$(sed -n 's/^\[  ERROR   \] --- //p' <<<"$found" | sed 's/\[   LINE   \] --- / /; s/^ //')
        printf '%s: %s: %s%s\n' "$name" "$test" "$(tail -n 1 <<<"$found")" "${reason:+: $reason}"
    fi
    restore
done
echo "${#names[@]} patches"
exit "$failed"
