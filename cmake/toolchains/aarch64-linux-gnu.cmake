# For building on another machine for 64-bit ARM with Debian's libraries (tools/cross-aarch64.sh).
# OPENRT_SYSROOT is a folder with a Debian for arm64 in which the -dev packages of
# tools/install-packages.sh are unpacked. If qemu's emulator of user programs is installed, CMake
# runs built programs with it (manual pages, ctest).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(OPENRT_SYSROOT "" CACHE PATH "A Debian for arm64")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES OPENRT_SYSROOT)
set(CMAKE_SYSROOT ${OPENRT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Libraries of the sysroot that libraries of the sysroot link: the linker must not look for them in
# the folders of this machine.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${OPENRT_SYSROOT}/usr/lib/aarch64-linux-gnu")
set(CMAKE_SHARED_LINKER_FLAGS_INIT ${CMAKE_EXE_LINKER_FLAGS_INIT})
set(CMAKE_MODULE_LINKER_FLAGS_INIT ${CMAKE_EXE_LINKER_FLAGS_INIT})

set(ENV{PKG_CONFIG_SYSROOT_DIR} ${OPENRT_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${OPENRT_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${OPENRT_SYSROOT}/usr/share/pkgconfig)

# Python's interpreter is this machine's, its headers and the names of its modules are the target's.
file(GLOB python_headers ${OPENRT_SYSROOT}/usr/include/python3.*)
list(GET python_headers 0 python_headers)
string(REGEX REPLACE ".*/python3\\.([0-9]+)$" "3\\1" python_version "${python_headers}")
set(Python_INCLUDE_DIR ${python_headers} CACHE PATH "Python's headers for arm64")
set(PYTHON_MODULE_EXTENSION .cpython-${python_version}-aarch64-linux-gnu.so)

find_program(OPENRT_QEMU_AARCH64 NAMES qemu-aarch64-static qemu-aarch64)
if(OPENRT_QEMU_AARCH64)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${OPENRT_QEMU_AARCH64} -L ${OPENRT_SYSROOT})
endif()
