# For tests to source. Packages of npm are fetched by tools/setup alone: a test needs no network, and
# two that run at a time cannot fetch into one folder.

# needs_packages SOURCE NAME...: ends the test as skipped where one of them is absent.
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
