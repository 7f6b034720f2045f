# Writes the C header OUTPUT, which defines KILN_COMMIT, the short name of the git commit that the folder SOURCE
# has checked out: cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake. `kiln --version` prints it. The name is
# like "254e4dc", with a '+' if tracked files differ from the commit. In an archive made by `git archive`, it is
# the name of the archived commit, which git has written into commit.txt. Where neither git nor commit.txt tells
# the commit, it is "". A header that would stay the same is not written, so that nothing is compiled again.
find_program(git git)
file(READ ${SOURCE}/cmake/commit.txt archived)
set(commit "")
if(archived MATCHES "^([0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f])[0-9a-f]+\n$")
    set(commit ${CMAKE_MATCH_1})
elseif(git)
    execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --show-prefix --short=7 HEAD
        OUTPUT_VARIABLE found ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    # The first line is the prefix; it is empty if SOURCE is the top folder of its repository.
    if(NOT failed AND found MATCHES "^\n([0-9a-f]+)$")
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
