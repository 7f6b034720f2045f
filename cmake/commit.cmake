# Writes OUTPUT, a header that names the commit of the working tree in SOURCE, "254e4dc", with a '+' if
# tracked files have changed since. In an archive by `git archive`, the name is that of the archived commit;
# without git, it is "". A file that would stay the same is not written, so that nothing is compiled anew.
find_program(git git)
file(READ ${SOURCE}/cmake/commit.txt archived)
set(commit "")
if(archived MATCHES "^([0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f])[0-9a-f]+\n$")
    set(commit ${CMAKE_MATCH_1})
elseif(git)
    execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --show-prefix --short=7 HEAD
        OUTPUT_VARIABLE found ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    if(NOT failed AND found MATCHES "^\n([0-9a-f]+)$") # SOURCE is the top of a repository
        set(commit ${CMAKE_MATCH_1})
        execute_process(COMMAND ${git} -C ${SOURCE} diff --quiet HEAD --
            ERROR_QUIET RESULT_VARIABLE changed)
        if(changed)
            string(APPEND commit "+")
        endif()
    endif()
endif()
set(text "#define KILN_COMMIT \"${commit}\"\n")
set(before "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
    file(WRITE ${OUTPUT} "${text}")
endif()
