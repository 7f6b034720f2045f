# Defines the functions that add tests to CTest, kiln_add_test and kiln_add_host_test, and the table of the tests'
# durations, from which their time limits follow. A wrong time limit ends a sound test, or lets one that hangs go on
# too long.

set(KILN_TEST_TIMEOUT_SCALE 1 CACHE STRING
    "Factor on the time limits of tests, for machines that are slow or busy: 1, 2, 3...")
if(NOT KILN_TEST_TIMEOUT_SCALE MATCHES "^[1-9][0-9]*$")
    message(FATAL_ERROR
        "KILN_TEST_TIMEOUT_SCALE: found '${KILN_TEST_TIMEOUT_SCALE}', expected a whole number")
endif()

option(KILN_ALL_TESTS "Add the tests that only tools/test --all runs, and check all cases of the others" OFF)

# Durations of the tests that take more than a second, measured on two otherwise idle cores with cold caches. Each
# row begins with a number of seconds, and then names the tests that take at most so long. The entry "NAME/PARTS"
# cuts the test NAME into PARTS parts, the longest of which takes at most so long. The entry "all.NAME" is for the
# test NAME with KILN_ALL_TESTS, when it checks all its cases and not only a sample (test_is_full,
# tests/support/parts.h).
set(kiln_test_times
    "3 fuzz.draw completion.bash completion.fish cli.batch cli.decoder cli.encode cli.events cli.limits cli.output cli.pipe cli.stdin docs.figures
        docs.jobs docs.library docs.python farm.schemas farm.tasks faults.address faults.flat_png
        faults.kill_flipbook faults.starved_mp4 fuzz.answers fuzz.part gpu.backdrop gpu.backdrop_turned
        gpu.bloom gpu.calibrate gpu.coarse gpu.exact gpu.frame gpu.lamp_kinds gpu.lamps gpu.post_techniques
        gpu.small_billboards gpu.solid_lamps gpu.sort_spread gpu.sort_trial gpu.spheres gpu.stages gpu.suite gpu.update
        hostile_slow_helper mutation.none schema.ajv shader.sim.step tree.check tree.entrance tree.format tree.planted tree.size unit.bounces
        unit.depth_maps unit.fragments unit.gas_matter unit.gas_solids unit.gas_sources unit.gas_states unit.image unit.output unit.parts unit.scene_place unit.sort unit.sources unit.state unit.stopping
        unit.surface_cache unit.threads unit.triangles unit.video_in unit.volume"
    "5 tree.conversions gpu.gas_frames unit.gas_depth completion.zsh all.gpu.small_billboards cli.bench cli.compare cli.figure cli.man cli.shards cli.test fuzz.journal
        gpu.backdrop_shapes gpu.occlusion gpu.particles gpu.rasters hostile_smoke install mutation.nodes
        mutation.shapes mutation.turned python.module queue.smoke unit.clips unit.field unit.gas_window unit.sun_cover"
    "10 hostile_results cli.new all.gpu.lamps all.gpu.spheres all.shader.sim.step cli.bench_against cli.gas_jobs cli.render cli.stop docs.scenes
        fuzz.mesh golden.software gpu.baked gpu.billboards gpu.crowds gpu.instances gpu.lens gpu.long_loops gpu.oit gpu.shadows
        gpu.shutter gpu.sort gpu.sources gpu.states hostile_swap mutation.effects package.lintian unit.baked unit.host unit.motion
        unit.slots unit.gas_new_air versions.0.1"
    "20 gpu.gas gpu.gas_depth all.gpu.billboards all.gpu.instances all.gpu.oit all.gpu.shadows all.gpu.solid_lamps all.gpu.sort all.gpu.sources
        all.unit.fragments all.unit.host/3 all.unit.sizes cli.sizes golden.readers gpu.backdrops
        queue.attacks report.page tree.flicker"
    "40 all.gpu.backdrops/2 all.gpu.baked all.gpu.crowds all.gpu.rasters/2 all.gpu.simulate/5 cli.bench_suites gpu.events
        gpu.nodes gpu.simulate tree.tidy/4"
    "80 all.gpu.events golden.suite all.unit.scene_place farm.slurm package.ci package.container"
    "120 all.gpu.nodes package.install sanitize.build"
    "300 all.hostile_swap hostile_slow_helper_full package.release"
)

# kiln_test_time(name prefix): looks up the test `name` in the table. Sets three variables in the caller:
# PREFIX_seconds, its duration; PREFIX_parts, its number of parts; PREFIX_found, whether the table has it. A test
# that the table lacks takes one second and has one part.
function(kiln_test_time name prefix)
    set(${prefix}_seconds 1 PARENT_SCOPE)
    set(${prefix}_parts 1 PARENT_SCOPE)
    set(${prefix}_found FALSE PARENT_SCOPE)
    foreach(row IN LISTS kiln_test_times)
        string(REGEX MATCHALL "[^ \n]+" entries "${row}")
        list(POP_FRONT entries seconds)
        foreach(entry IN LISTS entries)
            if(entry MATCHES "^([^/]+)(/([0-9]+))?$" AND CMAKE_MATCH_1 STREQUAL name)
                set(${prefix}_seconds ${seconds} PARENT_SCOPE)
                set(${prefix}_found TRUE PARENT_SCOPE)
                if(CMAKE_MATCH_3)
                    set(${prefix}_parts ${CMAKE_MATCH_3} PARENT_SCOPE)
                endif()
            endif()
        endforeach()
    endforeach()
endfunction()

# kiln_add_test(name label [ALL] [TIMES test] [SANITIZED] COMMAND command... [PROPERTIES name value...]): adds a
# test. Its time limit, after which CTest ends a test that hangs, is ten times its duration in the table, but at
# least two minutes and, unless the label is `package`, at most fifteen. The duration is also the test's COST: CTest
# starts long tests first, so that no core is idle at the end. A test in parts becomes several tests NAME.1, NAME.2
# and so on; the command's last argument says which part it runs, such as "1/2". A test that takes at most a second
# also has the label `quick`.
#   ALL        adds the test only with KILN_ALL_TESTS
#   TIMES      names another test, whose duration in the table is used for this one
#   SANITIZED  says that the program has sanitizers even if the build has none, so that it takes four times as long
function(kiln_add_test name label)
    cmake_parse_arguments(PARSE_ARGV 2 test "SANITIZED;ALL" "TIMES" "COMMAND;PROPERTIES")
    if(test_ALL AND NOT KILN_ALL_TESTS)
        return()
    endif()
    if(NOT test_TIMES)
        set(test_TIMES ${name})
    endif()
    kiln_test_time(${test_TIMES} test)
    kiln_test_time(all.${name} full)
    if(full_found AND KILN_ALL_TESTS)
        set(test_seconds ${full_seconds})
        set(test_parts ${full_parts})
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
    if(test_seconds LESS_EQUAL 1)
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

# The build target host_tests builds all programs that kiln_add_host_test runs. The target quick_host_tests builds
# only the programs that build quickly with sanitizers. The test sanitize.build builds one of the two targets with
# sanitizers.
add_custom_target(host_tests)
add_custom_target(quick_host_tests)

# kiln_add_host_test(name label sanitized [SANITIZED_QUICKLY] COMMAND target argument...): adds a test that needs no
# GL device, and a second test, sanitize.SANITIZED, which runs the same program from the build with sanitizers
# (tests/tree/sanitize.sh). The second test is added only with KILN_ALL_TESTS or SANITIZED_QUICKLY, which says that
# the program builds quickly with sanitizers. A build that itself has sanitizers gets no second tests.
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
        # With allocator_may_return_null, a sanitizer does not end a program that asks for an absurd amount of
        # memory: malloc returns NULL, and kiln must report the error.
        kiln_add_test(sanitize.${sanitized} sanitize ${when} SANITIZED TIMES ${name}
            COMMAND ${CMAKE_BINARY_DIR}/sanitize/${folder}/${target} ${test_COMMAND}
            PROPERTIES FIXTURES_REQUIRED sanitized
            ENVIRONMENT "ASAN_OPTIONS=allocator_may_return_null=1;${leaks}")
    endif()
endfunction()
