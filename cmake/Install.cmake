# What `cmake --install` lays down, in components that become packages (Packages.cmake): libraries with their plug-ins, headers
# (the generated xvrml/nodes.h too), programs, the Python package, CMake packages `openrt` and `xvrml`, pkg-config files. Manual
# pages are ManPages.cmake's. The installed tree can be moved.
include(CMakePackageConfigHelpers)
set(openrt_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/openrt)
set(xvrml_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/xvrml)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
set(namelink NAMELINK_COMPONENT dev)
if(OPENRT_WHEEL)
  set(namelink NAMELINK_SKIP)
endif()

install(TARGETS openrt openrt_headers EXPORT openrt_targets LIBRARY COMPONENT libopenrt ${namelink})
install(DIRECTORY libopenrt/include/openrt DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
get_property(shaders GLOBAL PROPERTY OPENRT_SHADERS)
install(TARGETS ${shaders} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/openrt/shaders COMPONENT libopenrt)

set_target_properties(xvrml_openrt PROPERTIES EXPORT_NAME openrt)
install(TARGETS xvrml xvrml_openrt xvrml_script_headers EXPORT xvrml_targets LIBRARY COMPONENT libxvrml ${namelink})
install(DIRECTORY libxvrml/include/xvrml DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
get_target_property(xvrml_includes xvrml INTERFACE_INCLUDE_DIRECTORIES)
foreach(folder ${xvrml_includes}) # the folder of generated headers is the one in the build tree
  if(folder MATCHES "^\\$<BUILD_INTERFACE:(${CMAKE_BINARY_DIR}.*)>$")
    install(DIRECTORY ${CMAKE_MATCH_1}/xvrml DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  endif()
endforeach()
install(TARGETS nodegen)
foreach(program vv openrt-replay openrt-worker)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME COMPONENT vv)
  endif()
endforeach()
install(TARGETS xvrml-script-host DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/xvrml COMPONENT libxvrml)
install(DIRECTORY libxvrml/nodes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/xvrml/nodes FILES_MATCHING PATTERN "*.node")
get_property(script_engines GLOBAL PROPERTY XVRML_SCRIPT_ENGINES)
foreach(engine IN LISTS script_engines)
  if(engine STREQUAL script_python) # it needs the package
    set(component python)
  else()
    set(component libxvrml)
  endif()
  install(TARGETS ${engine} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/xvrml/scripts COMPONENT ${component})
endforeach()
if(OPENRT_PYTHON)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/python/xvrml/ DESTINATION ${openrt_python_place} COMPONENT python PATTERN "__pycache__" EXCLUDE)
endif()
install(FILES README.md LICENSE CHANGELOG.md ${CMAKE_BINARY_DIR}/libxvrml/generated/nodes.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT doc)

foreach(package openrt xvrml)
  install(EXPORT ${package}_targets NAMESPACE ${package}:: DESTINATION ${${package}_cmake_dir} FILE ${package}-targets.cmake)
  configure_package_config_file(cmake/${package}-config.cmake.in ${CMAKE_BINARY_DIR}/package/${package}-config.cmake
                                INSTALL_DESTINATION ${${package}_cmake_dir} PATH_VARS CMAKE_INSTALL_BINDIR CMAKE_INSTALL_DATADIR)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/${package}-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/package/${package}-config.cmake ${CMAKE_BINARY_DIR}/package/${package}-config-version.cmake
          DESTINATION ${${package}_cmake_dir})
endforeach()
install(FILES cmake/OpenrtShader.cmake DESTINATION ${openrt_cmake_dir})
install(FILES cmake/XvrmlNodes.cmake DESTINATION ${xvrml_cmake_dir})
install(FILES cmake/XvrmlScript.cmake DESTINATION ${xvrml_cmake_dir})

# From lib/pkgconfig to the prefix, so that the tree can be moved: pkg-config knows where its file lies.
file(RELATIVE_PATH pkgconfig_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pkgconfig_to_prefix ${pkgconfig_to_prefix})
foreach(package openrt xvrml)
  configure_file(cmake/${package}.pc.in ${CMAKE_BINARY_DIR}/package/${package}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/package/${package}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
