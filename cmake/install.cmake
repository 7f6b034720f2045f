# Lists what `cmake --install` installs: the program kiln, and kiln-decode, the separate process that decodes
# strangers' files; the library with its headers, pkg-config file and CMake package; the scenes, examples and
# documents; the completions of bash, zsh and fish. docs/CMakeLists.txt adds the manual pages and the JSON schemas, and
# python/CMakeLists.txt the Python module.

# The pkg-config file computes the prefix of the installation from the folder in which it lies, so that any
# --prefix works. A program that links the static library libkiln.a must also link the libraries that kiln uses.
# `pkg-config --static` and the CMake target kiln::kiln_static name them.
include(CMakePackageConfigHelpers)
file(RELATIVE_PATH kiln_pc_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(JOIN " " kiln_pc_requires ${kiln_linked_packages})
configure_file(cmake/kiln.pc.in ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc @ONLY)
set(kiln_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
configure_package_config_file(cmake/kilnConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/kilnConfig.cmake
    INSTALL_DESTINATION ${kiln_cmake_folder} PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/kilnConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
set_target_properties(kiln_shared PROPERTIES EXPORT_NAME kiln)
install(TARGETS kiln_program kiln)
install(TARGETS kiln_shared EXPORT kilnTargets
    LIBRARY NAMELINK_COMPONENT development INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT kilnTargets NAMESPACE kiln:: DESTINATION ${kiln_cmake_folder})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kilnConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/kilnConfigVersion.cmake
    DESTINATION ${kiln_cmake_folder})
install(TARGETS kiln_decode_program kiln_openexr kiln_draco DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/kiln)
set(kiln_api_headers kiln.h kiln_compare.h kiln_job.h kiln_limits.h kiln_params.h kiln_sandbox.h)
list(TRANSFORM kiln_api_headers PREPEND lib/)
install(FILES ${kiln_api_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(GLOB kiln_documents CONFIGURE_DEPENDS docs/*.md)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${kiln_documents} DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY docs/ci docs/images DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY scenes examples DESTINATION ${CMAKE_INSTALL_DATADIR}/kiln USE_SOURCE_PERMISSIONS)
install(FILES cmd/completion/kiln.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME kiln)
install(FILES cmd/completion/_kiln DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES cmd/completion/kiln.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
