# Every library that kiln links, from pkg-config; a missing one names the script that installs it.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(KILN_DEPS IMPORTED_TARGET epoxy cglm libpng libfyaml OpenEXR
    libavcodec libavformat libavutil libswscale)
# Headers only: libepoxy loads EGL when it is first called, so that a machine without it gets an
# error from kiln, not from the loader.
pkg_check_modules(KILN_EGL egl)
if(NOT KILN_DEPS_FOUND OR NOT KILN_EGL_FOUND)
    message(FATAL_ERROR "A library is missing; run tools/setup to install all that kiln needs.")
endif()
add_library(kiln_dependencies INTERFACE)
find_library(KILN_EXR_CORE OpenEXRCore REQUIRED)
target_link_libraries(kiln_dependencies INTERFACE PkgConfig::KILN_DEPS ${KILN_EXR_CORE}
    Threads::Threads m)
