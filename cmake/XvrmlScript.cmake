# xvrml_add_script_engine(NAME SOURCE...): builds a script-engine plug-in NAME.so in
# <build>/lib/xvrml/scripts, target script_NAME. A plug-in uses the SDK's header (xvrml/xscript.h)
# and links no library of XVRML. The caller links the libraries of its language:
# target_link_libraries(script_NAME PRIVATE ...). This file is part of the project and of the
# installed CMake package.
include_guard(GLOBAL)
function(xvrml_add_script_engine name)
  add_library(script_${name} MODULE ${ARGN})
  set_target_properties(script_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden
                        C_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/xvrml/scripts)
  target_compile_features(script_${name} PRIVATE cxx_std_20 c_std_99)
  if(NOT APPLE) # same hardening as the programs that load it
    target_link_options(script_${name} PRIVATE LINKER:-z,relro,-z,now,-z,noexecstack)
  endif()
  target_link_libraries(script_${name} PRIVATE xvrml::script_headers)
  if(TARGET project_options)
    target_link_libraries(script_${name} PRIVATE project_options)
  endif()
  if(NOT TARGET scripts)
    add_custom_target(scripts) # all script engines of a project
  endif()
  add_dependencies(scripts script_${name})
  set_property(GLOBAL APPEND PROPERTY XVRML_SCRIPT_ENGINES script_${name})
endfunction()
