# openrt_add_shader(NAME SOURCE...): builds a shader plug-in NAME.so in <build>/lib/openrt/shaders.
# A plug-in uses the SDK's headers (openrt/openrts.h, openrts.hpp) and links no library of OpenRT.
# This file is part of the project and of the installed CMake package.
include_guard(GLOBAL)
function(openrt_add_shader name)
  add_library(shader_${name} MODULE ${ARGN})
  set_target_properties(shader_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden
                        C_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/openrt/shaders)
  target_compile_features(shader_${name} PRIVATE cxx_std_20)
  if(NOT APPLE) # same hardening as the programs that load it
    target_link_options(shader_${name} PRIVATE LINKER:-z,relro,-z,now,-z,noexecstack)
  endif()
  target_link_libraries(shader_${name} PRIVATE openrt::headers)
  # No contraction into fused multiply-adds: openrts_lanes.hpp promises the same bytes for every instruction set. Without
  # errno a square root is one instruction.
  target_compile_options(shader_${name} PRIVATE
                         $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off -fno-math-errno>)
  if(TARGET project_options)
    target_link_libraries(shader_${name} PRIVATE project_options)
  endif()
  if(NOT TARGET shaders)
    add_custom_target(shaders) # all shader plug-ins of a project
  endif()
  add_dependencies(shaders shader_${name})
  set_property(GLOBAL APPEND PROPERTY OPENRT_SHADERS shader_${name})
endfunction()
