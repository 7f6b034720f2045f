# Chooses the SIMD levels that a build has (plain, avx2, avx512, neon: lib/base/simd.h), gives the compiler's flags
# for each level, and generates the C files that tell kiln which levels were built.

# The compiler flags of each SIMD level. They allow the instructions whose presence kiln_simd_has (lib/base/simd.c)
# checks when kiln runs.
set(kiln_simd_plain)
set(kiln_simd_avx2 -mavx2 -mbmi -mbmi2)
set(kiln_simd_avx512 -mbmi -mbmi2 -mavx512f -mavx512bw -mavx512dq -mavx512vl -mprefer-vector-width=512)
set(kiln_simd_neon)

set(KILN_SIMD_LEVELS all CACHE STRING
    "Levels of vectors to compile for: all of the target's processor, native (the widest that this machine has), or a list of plain, avx2, avx512, neon")

# Sets `result` to the name of the widest SIMD level that the machine on which CMake runs can execute. A level needs
# the instructions that kiln_simd_has (lib/base/simd.c) checks when kiln runs.
function(kiln_native_level result)
    set(level plain)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
        set(level neon)
    elseif(EXISTS /proc/cpuinfo)
        file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
        string(REGEX MATCHALL "[a-z0-9_]+" flags "${flags}")
        set(of_avx2 avx2 bmi1 bmi2)
        set(of_avx512 ${of_avx2} avx512f avx512bw avx512dq avx512vl)
        foreach(candidate avx2 avx512)
            list(REMOVE_ITEM of_${candidate} ${flags})
            if(NOT of_${candidate})
                set(level ${candidate})
            endif()
        endforeach()
    endif()
    set(${result} ${level} PARENT_SCOPE)
endfunction()

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kiln_levels_of_processor plain avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    set(kiln_levels_of_processor plain neon)
else()
    set(kiln_levels_of_processor plain)
endif()
if(KILN_SIMD_LEVELS STREQUAL all)
    set(kiln_levels ${kiln_levels_of_processor})
else()
    kiln_native_level(native)
    set(kiln_levels ${KILN_SIMD_LEVELS})
    list(TRANSFORM kiln_levels REPLACE "^native$" ${native})
    list(REMOVE_DUPLICATES kiln_levels)
endif()
foreach(level IN LISTS kiln_levels)
    if(NOT level IN_LIST kiln_levels_of_processor)
        list(JOIN kiln_levels_of_processor ", " allowed)
        message(FATAL_ERROR "KILN_SIMD_LEVELS: found '${level}', expected all, native or some of ${allowed}")
    endif()
endforeach()

# kiln_simd_target(target level source...): adds an object library of sources that are compiled for one SIMD level.
function(kiln_simd_target target level)
    add_library(${target} OBJECT ${ARGN})
    string(TOUPPER ${level} upper)
    target_compile_definitions(${target} PRIVATE KILN_SIMD_LEVEL=${level} KILN_LEVEL_${upper})
    target_compile_options(${target} PRIVATE ${kiln_simd_${level}})
endfunction()

# kiln_simd_tables(result folder pattern): writes a C source for each function or table of functions that a header
# exports by KILN_SIMD_DECLARE. The source defines an array of the export's addresses, one for each SIMD level. The
# headers are the files below `folder` that match `pattern`, and are included by their paths in `folder`. Sets
# `result` to the list of the written sources.
function(kiln_simd_tables result folder pattern)
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/${pattern})
    list(REMOVE_ITEM headers base/simd.h)
    set(sources)
    foreach(header IN LISTS headers)
        file(STRINGS ${folder}/${header} declarations REGEX "^KILN_SIMD_DECLARE")
        if(declarations)
            set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${header})
        endif()
        foreach(declaration IN LISTS declarations)
            string(REGEX REPLACE "^.*, *([a-z0-9_]+)\\);?$" "\\1" name "${declaration}")
            set(text "#include \"${header}\"\n\n")
            string(APPEND text
                "__typeof__(&${name}_plain) const ${name}_levels[KILN_SIMD_COUNT] = {\n")
            foreach(level IN LISTS kiln_levels)
                string(TOUPPER ${level} upper)
                string(APPEND text "    [KILN_SIMD_${upper}] = &${name}_${level},\n")
            endforeach()
            string(APPEND text "};\n")
            get_filename_component(room ${header} DIRECTORY)
            set(source ${CMAKE_CURRENT_BINARY_DIR}/levels/${room}/${name}.c)
            file(CONFIGURE OUTPUT ${source} CONTENT "${text}" @ONLY)
            list(APPEND sources ${source})
        endforeach()
    endforeach()
    set(${result} ${sources} PARENT_SCOPE)
endfunction()

# kiln_built_levels(result): writes the C source of kiln_simd_built_levels, an array that says for each SIMD level
# whether the build has it. Sets `result` to the path of the source.
function(kiln_built_levels result)
    set(text "#include \"base/simd.h\"\n\nconst bool kiln_simd_built_levels[KILN_SIMD_COUNT] = {\n")
    foreach(level IN LISTS kiln_levels)
        string(TOUPPER ${level} upper)
        string(APPEND text "    [KILN_SIMD_${upper}] = true,\n")
    endforeach()
    string(APPEND text "};\n")
    set(source ${CMAKE_CURRENT_BINARY_DIR}/levels/built_levels.c)
    file(CONFIGURE OUTPUT ${source} CONTENT "${text}" @ONLY)
    set(${result} ${source} PARENT_SCOPE)
endfunction()
