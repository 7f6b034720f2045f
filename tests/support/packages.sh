# Lets a test end as skipped if the npm packages that it needs are not installed. Tests source this
# file, which has the function needs_packages. It fetches nothing: only tools/setup does, so that
# tests need no network, and no two tests fetch into the same folder at the same time.

# needs_packages SOURCE NAME...: ends the test as skipped (status 77) unless node and these packages
# are installed. SOURCE is the root of the source tree.
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
