# openrt_add_shader(NAME SOURCE...): a shader plug-in NAME.so in the shader folder; links against nothing of OpenRT.
function(openrt_add_shader name)
  add_library(shader_${name} MODULE ${ARGN})
  set_target_properties(shader_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden
                        C_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/openrt/shaders)
  if(TARGET openrt_headers)
    target_link_libraries(shader_${name} PRIVATE openrt_headers project_options)
  else()
    target_link_libraries(shader_${name} PRIVATE openrt::openrt)
  endif()
endfunction()
