# Defines compiler settings and output folders for every target of the project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
# Programs find the libraries, and the libraries their plug-ins, relative to themselves, so that the
# tree is relocatable. The build tree uses the run paths of the installed one. Otherwise CMake would
# pad the build tree's run paths with colons, in order to edit them at installation; the loader
# takes an empty element for the current folder, so programs would load libraries from the folder
# they are started in. System packages have no run paths, but their build tree needs them; CMake
# removes them at installation.
if(NOT CMAKE_SKIP_INSTALL_RPATH)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
endif()
if(APPLE)
  set(own_folder @loader_path)
else()
  set(own_folder $ORIGIN)
endif()
set(CMAKE_INSTALL_RPATH "${own_folder};${own_folder}/../lib;${own_folder}/../${CMAKE_INSTALL_LIBDIR}")
list(REMOVE_DUPLICATES CMAKE_INSTALL_RPATH)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON) # for libraries of others outside the system's folders

# Gives the compiler cache paths relative to the source folder, so that compilations in another
# checkout can be reused.
find_program(CCACHE ccache)
if(CCACHE)
  set(cached ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${cached})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${cached})
endif()

# Hardening: stack protection, size checks in string functions, read-only relocations once the
# loader is done, and control-flow protection of jumps (CET or BTI, if the compiler has it).
# tests/checks/hardening.py checks the built files.
include(CheckPIESupported)
check_pie_supported(LANGUAGES C CXX)
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-fcf-protection OPENRT_HAS_CF_PROTECTION)
# Clang takes this option for any processor, and then warns of it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  check_cxx_compiler_flag(-mbranch-protection=standard OPENRT_HAS_BRANCH_PROTECTION)
endif()
check_cxx_compiler_flag(-fstack-clash-protection OPENRT_HAS_STACK_CLASH_PROTECTION)
add_compile_options(-fstack-protector-strong $<$<BOOL:${OPENRT_HAS_CF_PROTECTION}>:-fcf-protection>
                    $<$<BOOL:${OPENRT_HAS_BRANCH_PROTECTION}>:-mbranch-protection=standard>
                    $<$<BOOL:${OPENRT_HAS_STACK_CLASH_PROTECTION}>:-fstack-clash-protection>)
if(NOT OPENRT_SANITIZE) # the sanitizers have checked functions of their own
  add_compile_options($<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
endif()
if(NOT APPLE) # whose files have another format, and are so anyway
  add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
endif()

add_library(project_options INTERFACE)
# No contraction into fused multiply-adds, so that the results do not depend on the compiler.
target_compile_options(project_options INTERFACE -Wall -Wextra -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno -fno-trapping-math
                       # false alarms on std::string in GCC 12 (its bug 105651)
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       $<$<BOOL:${OPENRT_WERROR}>:-Werror>)
# Bytes of files are compared as on x86: ARM's char has no sign unless it is asked for.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "86|AMD64")
  target_compile_options(project_options INTERFACE -fsigned-char)
endif()
if(OPENRT_SANITIZE)
  # With sanitizers GCC gives false warnings (see its manual on this warning).
  target_compile_options(project_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${OPENRT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${OPENRT_SANITIZE})
endif()
# the libraries report coverage to libFuzzer; the targets in tests/fuzz bring its main
if(OPENRT_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
