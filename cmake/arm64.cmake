# Cross compiler for Debian's arm64 (preset arm64). The libraries are those of a sysroot made by deploy/make-sysroot;
# FRAMEWATCH_SYSROOT names it (default: build/sysroot-arm64). Programs that a build runs, such as lcm-gen, are the
# host's. qemu-aarch64-static runs the tests.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FRAMEWATCH_SYSROOT)
set(FRAMEWATCH_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../build/sysroot-arm64 CACHE PATH "root of Debian's arm64 libraries")
get_filename_component(CMAKE_SYSROOT ${FRAMEWATCH_SYSROOT} ABSOLUTE)
if(NOT EXISTS ${CMAKE_SYSROOT}/usr/include/aarch64-linux-gnu)
  message(FATAL_ERROR "no sysroot ${CMAKE_SYSROOT}: make it by deploy/make-sysroot arm64 ${CMAKE_SYSROOT}")
endif()
set(CMAKE_FIND_ROOT_PATH ${CMAKE_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# pkg-config reads the sysroot's files alone, and puts the sysroot before their paths.
set(ENV{PKG_CONFIG_DIR} "")
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

find_program(FRAMEWATCH_QEMU qemu-aarch64-static)
if(FRAMEWATCH_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${FRAMEWATCH_QEMU};-L;${CMAKE_SYSROOT})
endif()
