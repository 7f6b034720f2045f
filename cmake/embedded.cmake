# Embeds shaders, scenes, templates of scenes and the HTML report's page into the library and the program, as C
# tables (lib/base/embedded.h), so that kiln has them wherever it is installed.

# kiln_embed(table root pattern...): generates a C source that defines the table `table` with the contents of all
# files below the folder `root` whose names match a pattern. Sets the variable named `table` in the caller to the
# path of the source.
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
