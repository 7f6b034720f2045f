# Defines how tests are added, and how long they may take.

set(KILN_TEST_TIMEOUT_SCALE 1 CACHE STRING
    "Factor on the time limits of tests, for machines that are slow or busy: 1, 2, 3...")
if(NOT KILN_TEST_TIMEOUT_SCALE MATCHES "^[1-9][0-9]*$")
    message(FATAL_ERROR
        "KILN_TEST_TIMEOUT_SCALE: found '${KILN_TEST_TIMEOUT_SCALE}', expected a whole number")
endif()

option(KILN_ALL_TESTS "Add the tests that only tools/test --all runs, and check all cases of the others" OFF)

# The seconds of each test that takes more than five, on two quiet cores with cold caches; where a test is cut
# into parts, the seconds of the longest part, and the number of parts. A row "all.NAME" says that the test NAME
# checks a sample of its cases unless KILN_ALL_TESTS is set (test_is_full, tests/support/parts.h), and what all
# cases take.
set(kiln_test_times
    "all.gpu.backdrops 30 2"
    "all.gpu.billboards 20"
    "all.gpu.crowds 30"
    "all.gpu.instances 15"
    "all.gpu.lamps 10"
    "all.gpu.oit 15"
    "all.gpu.rasters 30 2"
    "all.gpu.shadows 20"
    "all.gpu.simulate 30 5"
    "all.gpu.small_billboards 10"
    "all.gpu.solid_lamps 15"
    "all.gpu.sort 20"
    "all.gpu.spheres 10"
    "all.shader.sim.step 10"
    "all.unit.fragments 15"
    "all.unit.host 20 3"
    "cli.bench 10"
    "cli.bench_against 10"
    "cli.bench_suites 30"
    "cli.stop 15"
    "docs.scenes 10"
    "farm.slurm 80"
    "fuzz.mesh 10"
    "golden.readers 15"
    "golden.software 10"
    "golden.suite 20"
    "gpu.backdrops 10"
    "gpu.crowds 15"
    "gpu.lens 10"
    "gpu.long_loops 10"
    "gpu.oit 10"
    "gpu.rasters 15"
    "gpu.shadows 10"
    "gpu.shutter 10"
    "gpu.simulate 25"
    "gpu.sort 10"
    "mutation.effects 20"
    "package.ci 60"
    "package.container 60"
    "package.install 120"
    "package.lintian 10"
    "package.release 300"
    "queue.smoke 10"
    "report.page 20"
    "sanitize.build 90"
    "tree.tidy 40 4"
    "unit.host 15"
    "unit.motion 10"
    "unit.slots 10"
    "versions.0.1 10"
)

# Sets NAME_seconds and NAME_parts in the caller.
function(kiln_test_time name prefix)
    set(${prefix}_seconds 5 PARENT_SCOPE)
    set(${prefix}_parts 1 PARENT_SCOPE)
    foreach(row IN LISTS kiln_test_times)
        string(REPLACE " " ";" row "${row}")
        list(GET row 0 key)
        if(key STREQUAL name)
            list(GET row 1 seconds)
            set(${prefix}_seconds ${seconds} PARENT_SCOPE)
            list(LENGTH row columns)
            if(columns GREATER 2)
                list(GET row 2 parts)
                set(${prefix}_parts ${parts} PARENT_SCOPE)
            endif()
        endif()
    endforeach()
endfunction()

# kiln_add_test(name label [ALL] [TIMES row] [SANITIZED] COMMAND command... [PROPERTIES name value...]): adds a
# test with a limit for hangs: ten times its seconds, at least two minutes and, except for packages, at most
# fifteen. CTest begins long tests first, so that no core is idle at the end. A test that is cut into parts becomes
# NAME.1, NAME.2 and so on, which get "1/2" and so on as their last argument. A test of at most five seconds has
# the label "quick", too.
#   ALL        the test is added only with KILN_ALL_TESTS
#   TIMES      the row of kiln_test_times, if it is not that of the test's name
#   SANITIZED  the program has sanitizers whatever the build has, and takes four times as long
function(kiln_add_test name label)
    cmake_parse_arguments(PARSE_ARGV 2 test "SANITIZED;ALL" "TIMES" "COMMAND;PROPERTIES")
    if(test_ALL AND NOT KILN_ALL_TESTS)
        return()
    endif()
    if(NOT test_TIMES)
        set(test_TIMES ${name})
    endif()
    kiln_test_time(${test_TIMES} test)
    set(rows ${kiln_test_times})
    list(FILTER rows INCLUDE REGEX "^all[.]${name} ")
    if(rows AND KILN_ALL_TESTS)
        kiln_test_time(all.${name} test)
        list(FIND test_PROPERTIES ENVIRONMENT place)
        if(place GREATER_EQUAL 0)
            math(EXPR place "${place} + 1")
            list(GET test_PROPERTIES ${place} environment)
            list(REMOVE_AT test_PROPERTIES ${place})
            list(INSERT test_PROPERTIES ${place} "KILN_TESTS=all\\;${environment}")
        else()
            list(APPEND test_PROPERTIES ENVIRONMENT KILN_TESTS=all)
        endif()
    endif()
    if(KILN_SANITIZE OR test_SANITIZED)
        math(EXPR test_seconds "${test_seconds} * 4")
    endif()
    math(EXPR limit "${test_seconds} * 10")
    if(limit LESS 120)
        set(limit 120)
    elseif(limit GREATER 900 AND NOT label STREQUAL package)
        set(limit 900)
    endif()
    math(EXPR limit "${limit} * ${KILN_TEST_TIMEOUT_SCALE}")
    if(test_seconds LESS_EQUAL 5)
        list(APPEND label quick)
    endif()
    foreach(part RANGE 1 ${test_parts})
        set(full_name ${name})
        set(argument "")
        if(test_parts GREATER 1)
            set(full_name ${name}.${part})
            set(argument ${part}/${test_parts})
        endif()
        add_test(NAME ${full_name} COMMAND ${test_COMMAND} ${argument})
        set_tests_properties(${full_name} PROPERTIES LABELS "${label}" TIMEOUT ${limit}
            COST ${test_seconds} ${test_PROPERTIES})
    endforeach()
endfunction()

# The programs of the tests below: a build with sanitizers makes all of them, or those that it makes quickly.
add_custom_target(host_tests)
add_custom_target(quick_host_tests)

# kiln_add_host_test(name label sanitized [SANITIZED_QUICKLY] COMMAND target argument...): adds a test that needs
# no device, and a second one, sanitize.SANITIZED, of the same program out of the build with sanitizers
# (tests/tree/sanitize.sh). Without KILN_ALL_TESTS, only those tests have a second one whose programs are built
# QUICKLY. In the build with sanitizers itself there is no second test.
function(kiln_add_host_test name label sanitized)
    cmake_parse_arguments(PARSE_ARGV 3 test "SANITIZED_QUICKLY" "" "COMMAND")
    set(leaks
        LSAN_OPTIONS=print_suppressions=0:suppressions=${CMAKE_SOURCE_DIR}/tests/tree/leaks.supp)
    kiln_add_test(${name} ${label} COMMAND ${test_COMMAND} PROPERTIES ENVIRONMENT ${leaks})
    list(POP_FRONT test_COMMAND target)
    add_dependencies(host_tests ${target})
    set(when ALL)
    if(test_SANITIZED_QUICKLY)
        add_dependencies(quick_host_tests ${target})
        set(when)
    endif()
    if(NOT KILN_SANITIZE)
        file(RELATIVE_PATH folder ${CMAKE_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR})
        # With allocator_may_return_null, kiln itself must refuse an absurd size, and not the sanitizer.
        kiln_add_test(sanitize.${sanitized} sanitize ${when} SANITIZED TIMES ${name}
            COMMAND ${CMAKE_BINARY_DIR}/sanitize/${folder}/${target} ${test_COMMAND}
            PROPERTIES FIXTURES_REQUIRED sanitized
            ENVIRONMENT "ASAN_OPTIONS=allocator_may_return_null=1;${leaks}")
    endif()
endfunction()
