# Embeds text files into the library and the program, as C tables (lib/base/embedded.h).

# kiln_embed(table root pattern...): writes a C source that defines `table`, which has the files below the folder
# `root` whose names match a pattern. The caller's variable with the name of the table is set to the source's path.
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
