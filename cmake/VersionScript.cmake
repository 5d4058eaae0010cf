# openrt_version_script(TARGET NODE HEADERS... [PRIVATE NODE [SIBLINGS FOLDERS...]]): exports from a
# shared library exactly what its public headers declare, as symbols of the version NODE
# (cmake/tools/make_version_script.py). PRIVATE: also exports what the sources in SIBLINGS, other
# parts of the project, include from this library's private headers, under a version that names this
# release. With OPENRT_TESTS all of namespace xvrml is exported under the private version, because
# tests use internals.
find_package(Python3 COMPONENTS Interpreter)
function(openrt_version_script target node)
  cmake_parse_arguments(arg "" "PRIVATE" "HEADERS;SIBLINGS" ${ARGN})
  if(NOT Python3_Interpreter_FOUND)
    message(STATUS "No Python: ${target} without versions of its symbols")
    return()
  endif()
  if(APPLE) # its files have no versions of symbols; what is private is hidden all the same
    return()
  endif()
  # their run-time libraries need internal symbols
  if(OPENRT_SANITIZE OR OPENRT_FUZZ OR CMAKE_CXX_FLAGS MATCHES coverage)
    return()
  endif()
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  set(maker ${PROJECT_SOURCE_DIR}/cmake/tools/make_version_script.py)
  if(arg_SIBLINGS)
    list(TRANSFORM arg_SIBLINGS PREPEND --siblings=)
    set(private --private ${arg_PRIVATE} --of ${CMAKE_CURRENT_SOURCE_DIR} ${arg_SIBLINGS})
    # what ctest check_private_symbols asks for
    set_target_properties(${target} PROPERTIES OPENRT_SCRIPT_WITHOUT_TESTS "--of;${CMAKE_CURRENT_SOURCE_DIR};${arg_SIBLINGS};${arg_HEADERS}")
  endif()
  if(arg_PRIVATE AND OPENRT_TESTS)
    set(private --private ${arg_PRIVATE} --private-all xvrml)
  endif()
  add_custom_command(OUTPUT ${script}
                     COMMAND ${Python3_EXECUTABLE} ${maker} --output ${script} --version ${node} ${private} ${arg_HEADERS}
                     COMMAND ${CMAKE_COMMAND} -E touch ${script}
                     DEPENDS ${maker} ${arg_HEADERS} COMMENT "Version script of ${target}" VERBATIM)
  target_sources(${target} PRIVATE ${script})
  set_source_files_properties(${script} PROPERTIES HEADER_FILE_ONLY ON)
  target_link_options(${target} PRIVATE LINKER:--version-script=${script} LINKER:--no-undefined)
  set_target_properties(${target} PROPERTIES LINK_DEPENDS ${script})
endfunction()
