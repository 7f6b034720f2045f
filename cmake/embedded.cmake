# Files that are put into the library or the program, each folder as one C table (lib/base/embedded.h);
# the variable of a table's name is its source.
function(kiln_embed table root)
    list(TRANSFORM ARGN PREPEND ${root}/ OUTPUT_VARIABLE globs)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${root} ${globs})
    list(TRANSFORM files PREPEND ${root}/ OUTPUT_VARIABLE paths)
    string(REPLACE ";" "," files "${files}")
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${table}.c)
    set(script ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed.cmake)
    add_custom_command(
        OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DTABLE=${table} -DROOT=${root} -DFILES=${files}
            -P ${script}
        DEPENDS ${paths} ${script}
        VERBATIM)
    set(${table} ${source} PARENT_SCOPE)
endfunction()

kiln_embed(kiln_embedded_shaders ${CMAKE_CURRENT_SOURCE_DIR}/shaders
    *.h *.glsl *.comp *.vert *.geom *.frag)
kiln_embed(kiln_embedded_scenes ${CMAKE_CURRENT_SOURCE_DIR}/scenes fire_beam.yaml bench/*.yaml)
kiln_embed(kiln_embedded_templates ${CMAKE_CURRENT_SOURCE_DIR}/scenes/templates *.yaml)
kiln_embed(kiln_embedded_page ${CMAKE_CURRENT_SOURCE_DIR}/lib/report/page *.html *.css *.js)
