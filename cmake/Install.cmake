# Defines what `cmake --install` installs, in components that become packages (Packages.cmake):
# libraries with their plug-ins, headers (including the generated xvrml/nodes.h), programs, the
# Python package, the CMake packages `openrt` and `xvrml`, pkg-config files. Manual pages are in
# ManPages.cmake. The installed tree is relocatable.
include(CMakePackageConfigHelpers)
set(openrt_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/openrt)
set(xvrml_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/xvrml)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
set(namelink NAMELINK_COMPONENT dev)
if(OPENRT_WHEEL)
  set(namelink NAMELINK_SKIP)
endif()

install(TARGETS openrt rtgl openrt_headers EXPORT openrt_targets LIBRARY COMPONENT libopenrt ${namelink})
if(TARGET rtut)
  install(TARGETS rtut EXPORT openrt_targets LIBRARY COMPONENT librtut ${namelink})
endif()
install(DIRECTORY libopenrt/include/openrt DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
get_property(shaders GLOBAL PROPERTY OPENRT_SHADERS)
install(TARGETS ${shaders} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/openrt/shaders COMPONENT libopenrt)

set_target_properties(xvrml_openrt PROPERTIES EXPORT_NAME openrt)
install(TARGETS xvrml xvrml_openrt xvrml_script_headers EXPORT xvrml_targets LIBRARY COMPONENT libxvrml ${namelink})
install(DIRECTORY libxvrml/include/xvrml DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
get_target_property(xvrml_includes xvrml INTERFACE_INCLUDE_DIRECTORIES)
foreach(folder ${xvrml_includes}) # the folder of generated headers is in the build tree
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
install(TARGETS xvrml-script-host xvrml-decoder DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/xvrml COMPONENT libxvrml)
if(TARGET xvrml-step-reader)
  install(TARGETS xvrml-step-reader DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/xvrml COMPONENT step)
endif()
install(DIRECTORY libxvrml/nodes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/xvrml/nodes FILES_MATCHING PATTERN "*.node")
get_property(script_engines GLOBAL PROPERTY XVRML_SCRIPT_ENGINES)
foreach(engine IN LISTS script_engines)
  set(component libxvrml)
  set(folder ${CMAKE_INSTALL_LIBDIR}/xvrml/scripts)
  # it needs the Python package; in a wheel it also needs a Python process, so programs must not
  # find it
  if(engine STREQUAL script_python)
    set(component python)
    if(OPENRT_WHEEL)
      set(folder scripts)
    endif()
  endif()
  install(TARGETS ${engine} LIBRARY DESTINATION ${folder} COMPONENT ${component})
endforeach()
if(OPENRT_WHEEL) # fonts, and Tcl's procedures for trusted worlds, which a bare system lacks
  find_path(dejavu_fonts DejaVuSans.ttf PATHS /usr/share/fonts PATH_SUFFIXES truetype/dejavu dejavu TTF NO_DEFAULT_PATH REQUIRED)
  foreach(font Sans Sans-Bold SansMono SansMono-Bold Serif Serif-Bold)
    install(FILES ${dejavu_fonts}/DejaVu${font}.ttf DESTINATION share/xvrml/fonts COMPONENT libxvrml)
  endforeach()
  install(FILES tools/wheel/fonts.conf DESTINATION share/xvrml/fonts COMPONENT libxvrml)
  install(FILES /usr/share/doc/fonts-dejavu-core/copyright DESTINATION share/xvrml/fonts RENAME LICENSE COMPONENT libxvrml OPTIONAL)
  if(TARGET script_tcl)
    pkg_get_variable(tcl_prefix tcl prefix)
    find_path(tcl_library init.tcl PATHS ${tcl_prefix} PATH_SUFFIXES share/tcltk/tcl8.6 share/tcl8.6 lib/tcl8.6 NO_DEFAULT_PATH REQUIRED)
    install(DIRECTORY ${tcl_library}/ DESTINATION lib/xvrml/tcl8.6 COMPONENT libxvrml PATTERN "*.c" EXCLUDE PATTERN "tcltest*" EXCLUDE)
    install(FILES /usr/share/doc/libtcl8.6/copyright DESTINATION lib/xvrml/tcl8.6 RENAME license.terms COMPONENT libxvrml OPTIONAL)
  endif()
endif()
if(OPENRT_PYTHON)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/python/xvrml/ DESTINATION ${openrt_python_place} COMPONENT python PATTERN "__pycache__" EXCLUDE)
endif()
# Guides; their commands work in this folder as in a checkout.
install(FILES README.md LICENSE CHANGELOG.md ${CMAKE_BINARY_DIR}/libxvrml/generated/nodes.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT doc)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc PATTERN "site" EXCLUDE PATTERN "__pycache__" EXCLUDE
        PATTERN "examples/CMakeLists.txt" EXCLUDE)

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

# Path from lib/pkgconfig to the prefix. pkg-config resolves it against the file's folder, so that
# the tree is relocatable.
file(RELATIVE_PATH pkgconfig_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pkgconfig_to_prefix ${pkgconfig_to_prefix})
foreach(package openrt rtgl rtut xvrml)
  configure_file(cmake/${package}.pc.in ${CMAKE_BINARY_DIR}/package/${package}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/package/${package}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
