# How tests are added, and how long they may take.

set(KILN_TEST_TIMEOUT_SCALE 1 CACHE STRING
    "What the tests' limits are multiplied by, for machines that are slow or busy: 1, 2, 3...")
if(NOT KILN_TEST_TIMEOUT_SCALE MATCHES "^[1-9][0-9]*$")
    message(FATAL_ERROR
        "KILN_TEST_TIMEOUT_SCALE: found '${KILN_TEST_TIMEOUT_SCALE}', expected a whole number")
endif()

# Processor seconds of the tests that take more than five on the two quiet cores of CONTRIBUTING.md;
# where a test is cut into parts, those of the longest one, and how many there are.
set(kiln_test_times
    "gpu.simulate 30 5"
    "gpu.shadows 15 2"
    "gpu.lamps 25"
    "gpu.lamp_kinds 10"
    "gpu.solid_lamps 15"
    "gpu.lens 10"
    "gpu.bloom 10"
    "gpu.shutter 10"
    "gpu.backdrops 30 2"
    "gpu.rasters 20 2"
    "gpu.sort 20"
    "gpu.oit 15"
    "gpu.instances 10"
    "gpu.crowds 30"
    "gpu.billboards 10"
    "gpu.small_billboards 40"
    "gpu.particles 10"
    "gpu.coarse 10"
    "gpu.occlusion 10"
    "gpu.long_loops 10"
    "unit.host 20 3"
    "unit.motion 10"
    "unit.slots 10"
    "unit.fragments 10"
    "unit.sun_cover 10"
    "unit.field 10"
    "fuzz.mesh 15"
    "golden.suite 20"
    "golden.readers 15"
    "report.page 20"
    "schema.ajv 10"
    "farm.schemas 10"
    "queue.smoke 10"
    "python.module 10"
    "cli.bench 20"
    "cli.bench_against 10"
    "cli.stop 10"
    "cli.compare 10"
    "cli.test 10"
    "docs.scenes 10"
    "mutation.effects 20"
    "mutation.shapes 10"
    "mutation.turned 10"
    "farm.slurm 80"
    "package.release 300"
    "package.install 120"
    "package.lintian 10"
    "package.container 60"
    "package.ci 60"
    "tree.tidy 20 4"
    "sanitize.library 90"
    "sanitize.tests 60"
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

# kiln_add_test(name label [TIMES row] [SANITIZED] COMMAND command... [PROPERTIES name value...]): a
# test that CTest begins the earlier the longer it takes, so that no core is idle at the end. Its
# limit is for hangs: ten times what it takes, at least two minutes and, but for packages, at most
# fifteen. One that is
# cut into parts becomes NAME.1, NAME.2 and so on, which get "1/2" as their last argument. What takes
# no more than five seconds has the label "quick", too. TIMES: the row of another test. SANITIZED: it
# takes several times as long as that, whatever the build.
function(kiln_add_test name label)
    cmake_parse_arguments(PARSE_ARGV 2 test "SANITIZED" "TIMES" "COMMAND;PROPERTIES")
    if(NOT test_TIMES)
        set(test_TIMES ${name})
    endif()
    kiln_test_time(${test_TIMES} test)
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

# Builds all that sanitizers run.
add_custom_target(host_tests)

option(KILN_LONG_TESTS "Run long tests under the sanitizers, too" OFF)

# kiln_add_host_test(name label sanitized COMMAND target argument...): a test that needs no device.
# A second one, sanitize.SANITIZED, runs it as the sanitizers' build has it (tests/tree/sanitize.sh);
# in that build itself there is only the first. What takes more than five seconds has a second one
# only with KILN_LONG_TESTS.
function(kiln_add_host_test name label sanitized)
    cmake_parse_arguments(PARSE_ARGV 3 test "" "" "COMMAND")
    set(leaks
        LSAN_OPTIONS=print_suppressions=0:suppressions=${CMAKE_SOURCE_DIR}/tests/tree/leaks.supp)
    kiln_add_test(${name} ${label} COMMAND ${test_COMMAND} PROPERTIES ENVIRONMENT ${leaks})
    list(POP_FRONT test_COMMAND target)
    add_dependencies(host_tests ${target})
    kiln_test_time(${name} test)
    if(NOT KILN_SANITIZE AND (KILN_LONG_TESTS OR test_seconds LESS_EQUAL 5))
        file(RELATIVE_PATH folder ${CMAKE_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR})
        # An absurd size must be refused by kiln, not by the sanitizer.
        kiln_add_test(sanitize.${sanitized} sanitize SANITIZED TIMES ${name}
            COMMAND ${CMAKE_BINARY_DIR}/sanitize/${folder}/${target} ${test_COMMAND}
            PROPERTIES FIXTURES_REQUIRED sanitized
            ENVIRONMENT "ASAN_OPTIONS=allocator_may_return_null=1;${leaks}")
    endif()
endfunction()
