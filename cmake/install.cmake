# cmake --install: the program, the library, its header, a pkg-config file and the scenes.
configure_file(cmake/kiln.pc.in ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc @ONLY)
install(TARGETS kiln_program kiln)
install(FILES lib/kiln.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kiln)
