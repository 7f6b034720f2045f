# Finds the libraries that kiln needs, by pkg-config, and defines the target kiln_dependencies, which links them. If
# a library is missing, the error names the script that installs it.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
set(kiln_linked_packages epoxy libpng zlib libfyaml libzstd nettle)
pkg_check_modules(KILN_DEPS IMPORTED_TARGET ${kiln_linked_packages})
# kiln needs only the headers of EGL: libepoxy loads EGL at the first call, so a machine without EGL gets an error
# from kiln and not from the dynamic linker.
pkg_check_modules(KILN_EGL egl)
# kiln needs only the headers of the libraries of pictures, which kiln-decode loads for pictures of their kind
# (decode/jpeg.c, decode/webp.c, decode/tiff.c, decode/profile.c).
pkg_check_modules(KILN_PICTURES libjpeg libwebp libwebpdemux libtiff-4 lcms2)
# kiln needs only the header of Jansson, which kiln-decode loads for meshes (decode/gltf_json.c).
pkg_check_modules(KILN_JANSSON jansson)
# kiln needs only the headers of libseccomp, which is loaded when a process gives up rights (lib/base/confine.c).
pkg_check_modules(KILN_SECCOMP libseccomp)
# kiln needs only the headers of libdeflate, which is loaded when a small PNG is written (lib/output/libdeflate.c).
# Tests link the library.
pkg_check_modules(KILN_DEFLATE IMPORTED_TARGET libdeflate)
# kiln needs only the headers of FFmpeg, which is loaded when a clip is encoded or decoded (lib/base/ffmpeg.c).
# Tests link the libraries.
pkg_check_modules(KILN_FFMPEG IMPORTED_TARGET libavcodec libavformat libavutil libswscale)
# cglm has only headers: lib/base/matrix.h uses its inline functions.
pkg_check_modules(KILN_CGLM cglm)
# kiln links only the C core of OpenEXR. The rest of OpenEXR is C++, and the dynamic linker would load it at every
# start of kiln; only the module kiln-openexr.so links it (decode/exr_module.cc).
pkg_check_modules(KILN_EXR OpenEXR)
find_library(KILN_EXR_CORE OpenEXRCore)
# Only the module kiln-draco.so links Draco (decode/draco_module.cc).
pkg_check_modules(KILN_DRACO draco)
if(NOT KILN_DEPS_FOUND OR NOT KILN_EGL_FOUND OR
   NOT KILN_FFMPEG_FOUND OR NOT KILN_PICTURES_FOUND OR NOT KILN_SECCOMP_FOUND OR NOT KILN_DEFLATE_FOUND OR
   NOT KILN_CGLM_FOUND OR NOT KILN_EXR_FOUND OR NOT KILN_EXR_CORE OR
   NOT KILN_DRACO_FOUND OR NOT KILN_JANSSON_FOUND)
    message(FATAL_ERROR "A library is missing; run tools/setup to install all that kiln needs.")
endif()
add_library(kiln_dependencies INTERFACE)
target_include_directories(kiln_dependencies SYSTEM INTERFACE
    ${KILN_CGLM_INCLUDE_DIRS} ${KILN_EXR_INCLUDE_DIRS} ${KILN_FFMPEG_INCLUDE_DIRS})
target_link_libraries(kiln_dependencies INTERFACE PkgConfig::KILN_DEPS ${KILN_EXR_CORE}
    Threads::Threads ${CMAKE_DL_LIBS} m)
