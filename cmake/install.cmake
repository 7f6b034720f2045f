# cmake --install: the program, the library, its headers, a pkg-config file, the scenes and what bash
# and zsh complete command lines with. docs/ adds manual pages and the schema of scenes.

# The pkg-config file finds its prefix from where it lies, whatever --prefix it was installed to.
# A static library does not carry its dependencies: whoever links it needs them, too.
file(RELATIVE_PATH kiln_pc_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(JOIN " " kiln_pc_requires ${kiln_linked_packages})
set(kiln_pc_private "")
if(BUILD_SHARED_LIBS)
    set(kiln_pc_private ".private")
endif()
configure_file(cmake/kiln.pc.in ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc @ONLY)
install(TARGETS kiln_program kiln)
install(TARGETS kiln_decode_program DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/kiln)
file(GLOB kiln_headers CONFIGURE_DEPENDS lib/kiln*.h)
install(FILES ${kiln_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kiln)
install(FILES cmd/completion/kiln.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME kiln)
install(FILES cmd/completion/_kiln DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
