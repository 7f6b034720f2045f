# Finds the libraries that kiln links, by pkg-config. If one is missing, the error names the script that
# installs it.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
set(kiln_linked_packages epoxy libpng zlib libfyaml libzstd nettle)
pkg_check_modules(KILN_DEPS IMPORTED_TARGET ${kiln_linked_packages})
# Headers only: libepoxy loads EGL at the first call, so a machine without EGL gets an error from kiln
# and not from the dynamic linker.
pkg_check_modules(KILN_EGL egl)
# Headers only: assimp is loaded when a scene has a mesh (decode/mesh.c).
pkg_check_modules(KILN_ASSIMP assimp>=5)
# Headers only: libseccomp is loaded when a process confines itself (lib/base/confine.c).
pkg_check_modules(KILN_SECCOMP libseccomp)
# Headers only: libdeflate is loaded when a small PNG is written (lib/output/libdeflate.c). Tests link it.
pkg_check_modules(KILN_DEFLATE IMPORTED_TARGET libdeflate)
# Headers only: FFmpeg is loaded when a clip is encoded or decoded (lib/base/ffmpeg.c). Tests link it.
pkg_check_modules(KILN_FFMPEG IMPORTED_TARGET libavcodec libavformat libavutil libswscale)
# Headers only: lib/base/matrix.h uses inline functions of cglm.
pkg_check_modules(KILN_CGLM cglm)
# Only the C core of OpenEXR is linked: the rest is C++ and would be loaded at every start.
pkg_check_modules(KILN_EXR OpenEXR)
find_library(KILN_EXR_CORE OpenEXRCore)
if(NOT KILN_DEPS_FOUND OR NOT KILN_EGL_FOUND OR NOT KILN_ASSIMP_FOUND OR
   NOT KILN_FFMPEG_FOUND OR NOT KILN_SECCOMP_FOUND OR NOT KILN_DEFLATE_FOUND OR NOT KILN_CGLM_FOUND OR NOT KILN_EXR_FOUND OR NOT KILN_EXR_CORE)
    message(FATAL_ERROR "A library is missing; run tools/setup to install all that kiln needs.")
endif()
add_library(kiln_dependencies INTERFACE)
target_include_directories(kiln_dependencies SYSTEM INTERFACE
    ${KILN_CGLM_INCLUDE_DIRS} ${KILN_EXR_INCLUDE_DIRS} ${KILN_FFMPEG_INCLUDE_DIRS})
target_link_libraries(kiln_dependencies INTERFACE PkgConfig::KILN_DEPS ${KILN_EXR_CORE}
    Threads::Threads ${CMAKE_DL_LIBS} m)
