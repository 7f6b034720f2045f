# Toolchain file with which CMake cross-compiles kiln for arm64: cmake -DCMAKE_TOOLCHAIN_FILE=cmake/arm64.cmake
# -DKILN_ROOT=ROOT. ROOT is the sysroot: a folder with unpacked arm64 packages of the libraries that kiln needs;
# tools/arm64 makes one. `qemu-aarch64-static -L ROOT PROGRAM` runs a program of such a build.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES KILN_ROOT)
set(CMAKE_SYSROOT ${KILN_ROOT})
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH ${KILN_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${KILN_ROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${KILN_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${KILN_ROOT}/usr/share/pkgconfig)
