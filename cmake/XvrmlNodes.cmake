include_guard(GLOBAL)
# xvrml_generate_nodes(PREFIX NUMBERS spec.node...): runs nodegen on node specifications and sets
# PREFIX_sources and PREFIX_include. NUMBERS is the list of the nodes' numbers. It generates, in namespace xvrml::nodes, the header
# xvrml/nodes.h, one .cpp per component and the list of types, and also the callbacks of renderers
# (xvrml/node_renderer.h), the node reference nodes.md and the Python stub nodes.pyi. The files are
# in the build tree and are never committed.
function(xvrml_generate_nodes prefix numbers)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(sources ${out}/nodes_list.cpp ${out}/nodes_renderer.cpp)
  foreach(specification ${ARGN})
    cmake_path(GET specification STEM component)
    list(APPEND sources ${out}/nodes_${component}.cpp)
  endforeach()
  set(others ${out}/xvrml/nodes.h ${out}/xvrml/node_renderer.h ${out}/nodes.md ${out}/nodes.pyi)
  add_custom_command(OUTPUT ${sources} ${others}
                     COMMAND ${XVRML_NODEGEN} --numbers ${numbers} --output ${out} --reference ${out}/nodes.md
                             --stub ${out}/nodes.pyi ${ARGN}
                     DEPENDS ${XVRML_NODEGEN} ${numbers} ${ARGN} COMMENT "Generating nodes" VERBATIM)
  set(${prefix}_include ${out} PARENT_SCOPE)
  set(${prefix}_sources ${sources} ${out}/xvrml/nodes.h ${out}/xvrml/node_renderer.h PARENT_SCOPE)
endfunction()

# xvrml_add_nodes(NAME spec.node... source.cpp...): builds a node plug-in NAME.so in
# <build>/lib/xvrml/nodes. nodegen generates the header NAME_nodes.h and the tables from the
# specifications; the sources define each node's `implementation` (docs/node-plugins.md). This file
# is part of the project and of the installed CMake package.
function(xvrml_add_nodes name)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${name}_generated)
  set(generated ${out}/${name}_nodes.h ${out}/${name}_plugin.cpp)
  foreach(file ${ARGN})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    if(file MATCHES "\\.node$")
      cmake_path(GET file STEM component)
      list(APPEND generated ${out}/nodes_${component}.cpp)
      list(APPEND specifications ${file})
    else()
      list(APPEND sources ${file})
    endif()
  endforeach()
  if(TARGET nodegen)
    file(GLOB standard ${PROJECT_SOURCE_DIR}/libxvrml/nodes/*.node)
  else()
    file(GLOB standard ${XVRML_NODE_SPECIFICATIONS}/*.node)
  endif()
  list(TRANSFORM standard PREPEND --import= OUTPUT_VARIABLE imports)
  add_custom_command(OUTPUT ${generated} COMMAND ${XVRML_NODEGEN} --plugin ${name} --output ${out} ${imports} ${specifications}
                     DEPENDS ${XVRML_NODEGEN} ${specifications} ${standard} COMMENT "Generating nodes of ${name}" VERBATIM)
  add_library(nodes_${name} MODULE ${sources} ${generated})
  set_target_properties(nodes_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/xvrml/nodes)
  target_compile_features(nodes_${name} PRIVATE cxx_std_20)
  if(NOT APPLE) # same hardening as the programs that load it
    target_link_options(nodes_${name} PRIVATE LINKER:-z,relro,-z,now,-z,noexecstack)
  endif()
  target_include_directories(nodes_${name} PRIVATE ${out})
  if(TARGET xvrml::xvrml)
    target_link_libraries(nodes_${name} PRIVATE xvrml::xvrml)
  else()
    target_link_libraries(nodes_${name} PRIVATE xvrml)
  endif()
  if(NOT OPENRT_SANITIZE AND NOT APPLE) # the program contains the sanitizers' functions
    target_link_options(nodes_${name} PRIVATE -Wl,--no-undefined)
  endif()
endfunction()
