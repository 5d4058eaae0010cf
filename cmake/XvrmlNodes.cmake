# xvrml_generate_nodes(PREFIX spec.node...): runs nodegen on node specifications; sets PREFIX_sources and PREFIX_include.
# The header xvrml/nodes.h, one .cpp per component and the list of types come out, in namespace xvrml::nodes; beside them
# nodes.md, the node reference, and nodes.pyi, the Python stub. They lie in the build tree and are never committed.
function(xvrml_generate_nodes prefix)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(sources ${out}/nodes_list.cpp)
  foreach(specification ${ARGN})
    cmake_path(GET specification STEM component)
    list(APPEND sources ${out}/nodes_${component}.cpp)
  endforeach()
  set(others ${out}/xvrml/nodes.h ${out}/nodes.md ${out}/nodes.pyi)
  add_custom_command(OUTPUT ${sources} ${others}
                     COMMAND nodegen --output ${out} --reference ${out}/nodes.md --stub ${out}/nodes.pyi ${ARGN}
                     DEPENDS nodegen ${ARGN} COMMENT "Generating nodes" VERBATIM)
  set(${prefix}_include ${out} PARENT_SCOPE)
  set(${prefix}_sources ${sources} ${out}/xvrml/nodes.h PARENT_SCOPE)
endfunction()
