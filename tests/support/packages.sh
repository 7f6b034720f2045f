# Tests source this file to use packages of npm. Only tools/setup fetches them: so a test needs no network, and
# two tests do not fetch into one folder at the same time.

# needs_packages SOURCE NAME...: ends the test as skipped if one of these packages is absent.
needs_packages() {
    local package
    if ! command -v node >/dev/null; then
        echo "skipped: there is no node (tools/setup installs it)"
        exit 77
    fi
    for package in "${@:2}"; do
        if [[ ! -d $1/tests/node_modules/$package ]]; then
            echo "skipped: there is no npm package $package (tools/setup fetches it)"
            exit 77
        fi
    done
}
