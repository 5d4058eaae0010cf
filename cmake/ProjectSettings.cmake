# Compiler settings and output folders of every target of the project.
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
# Programs find the libraries, and the libraries their plug-ins, relative to themselves: the tree can be moved. The build tree has
# the run paths of the installed one. CMake would otherwise pad those of the build tree with colons, to edit them when it installs,
# and the loader takes an empty element for the current folder: programs would load libraries from wherever they are started.
# Packages of the system have no run paths, but the tree that they are built in needs them: CMake takes them away as it installs.
if(NOT CMAKE_SKIP_INSTALL_RPATH)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
endif()
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../lib;$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
list(REMOVE_DUPLICATES CMAKE_INSTALL_RPATH)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON) # libraries of others that are installed outside the system's folders

# The compiler cache takes paths relative to the source folder, so that what was compiled in another checkout counts.
find_program(CCACHE ccache)
if(CCACHE)
  set(cached ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${cached})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${cached})
endif()

# Hardening: the stack is guarded, string functions check sizes, function pointers of the loader are read-only once it is done, and
# jumps land where the compiler meant (CET, where the compiler has it). tests/checks/hardening.py reads it from what was built.
include(CheckPIESupported)
check_pie_supported(LANGUAGES C CXX)
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-fcf-protection OPENRT_HAS_CF_PROTECTION)
check_cxx_compiler_flag(-fstack-clash-protection OPENRT_HAS_STACK_CLASH_PROTECTION)
add_compile_options(-fstack-protector-strong $<$<BOOL:${OPENRT_HAS_CF_PROTECTION}>:-fcf-protection>
                    $<$<BOOL:${OPENRT_HAS_STACK_CLASH_PROTECTION}>:-fstack-clash-protection>)
if(NOT OPENRT_SANITIZE) # the sanitizers bring checked functions of their own
  add_compile_options($<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
endif()
add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)

add_library(project_options INTERFACE)
# No contraction into fused multiply-adds: the same bytes whatever the compiler makes of an expression.
target_compile_options(project_options INTERFACE -Wall -Wextra -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno -fno-trapping-math
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # false alarms on std::string in GCC 12 (its bug 105651)
                       $<$<BOOL:${OPENRT_WERROR}>:-Werror>)
if(OPENRT_SANITIZE)
  # With them GCC warns of what it cannot follow (its manual says so of this warning).
  target_compile_options(project_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${OPENRT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${OPENRT_SANITIZE})
endif()
if(OPENRT_FUZZ) # the libraries report coverage to libFuzzer, the targets in tests/fuzz bring its main
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
