# Embeds every file under shaders/ into the library as one C table (lib/gpu/program.c looks files
# up by their path under shaders/).
file(GLOB_RECURSE kiln_shader_files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/shaders
    shaders/*.h shaders/*.glsl shaders/*.comp shaders/*.vert shaders/*.geom shaders/*.frag)
set(kiln_embedded_shaders ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.c)
list(TRANSFORM kiln_shader_files PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/shaders/
    OUTPUT_VARIABLE kiln_shader_paths)
add_custom_command(
    OUTPUT ${kiln_embedded_shaders}
    COMMAND ${CMAKE_COMMAND} -DOUT=${kiln_embedded_shaders}
        -DROOT=${CMAKE_CURRENT_SOURCE_DIR}/shaders "-DFILES=${kiln_shader_files}"
        -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${kiln_shader_paths} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed.cmake
    VERBATIM)
