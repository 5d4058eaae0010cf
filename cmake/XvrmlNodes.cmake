# xvrml_generate_nodes(PREFIX spec.node...): runs nodegen on node specifications; sets PREFIX_sources and PREFIX_include.
# The header xvrml/nodes.h and one .cpp per component come out, in namespace xvrml::nodes.
function(xvrml_generate_nodes prefix)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(${prefix}_include ${out} PARENT_SCOPE)
  set(${prefix}_sources "" PARENT_SCOPE)
endfunction()
