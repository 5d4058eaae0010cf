# Builds Debian packages with CPack, one for each component of Install.cmake. `make deb` configures
# with prefix /usr, builds and packs. dpkg-shlibdeps determines the dependencies from the linked
# libraries, so a new library needs no entry here.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME openrt)
set(CPACK_PACKAGE_VENDOR "The OpenRT authors")
set(CPACK_PACKAGE_CONTACT "The OpenRT authors <maintainers@openrt.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Lets dpkg-shlibdeps find the libraries of the project's other packages.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)

# openrt_package(COMPONENT NAME SECTION DEPENDS SUMMARY TEXT)
function(openrt_package component name section depends summary text)
  string(TOUPPER ${component} upper)
  set(prefix CPACK_DEBIAN_${upper})
  set(${prefix}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(${prefix}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(${prefix}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(${prefix}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(packaged_components ${packaged_components} ${component} PARENT_SCOPE)
endfunction()

set(same "(= ${PROJECT_VERSION}-1)")
openrt_package(libopenrt libopenrt0 libs "" "ray tracing API in OpenGL's manner"
  "A C library that renders triangles, spheres and other primitives by ray\ntracing on the CPU, answers ray queries and runs shaders, lights, cameras and\nenvironments as plug-ins. The package holds the library and its plug-ins.")
if(TARGET rtut)
  openrt_package(librtut librtut0 libs "libopenrt0 ${same}" "windows for OpenGL programs that OpenRT draws"
    "Windows, events and pictures in files, in GLUT's manner, for programs that draw\nwith OpenRT's header for OpenGL 1.1.")
endif()
openrt_package(libxvrml libxvrml0 libs "libopenrt0 ${same}" "VRML97 scene graph"
  "Reads, runs and writes VRML97 worlds (ISO/IEC 14772-1): all nodes, events,\nsensors, prototypes and Scripts, and draws them through OpenRT. The package\nholds the libraries, the script engines, the process that Scripts run in, and\nthe one that decodes pictures and sounds.")
if(TARGET xvrml-step-reader)
  openrt_package(step xvrml-step graphics "libxvrml0 ${same}" "STEP models for vv and XVRML"
    "The process that reads STEP models (ISO 10303-21) by Open CASCADE.")
endif()
openrt_package(dev libopenrt-dev libdevel "libopenrt0 ${same}, libxvrml0 ${same}, libimath-dev"
  "headers and tools for OpenRT and XVRML"
  "For programs that render or use worlds, and for plug-ins: shaders, nodes,\nscript engines. CMake packages openrt and xvrml, pkg-config files, the node\ngenerator nodegen, manual pages of the C interface.")
openrt_package(vv vv graphics "libopenrt0 ${same}, libxvrml0 ${same}" "ray-traced VRML97 browser"
  "Opens a VRML97 world in a window to walk through, or makes pictures and films\nof it without a display. With the worker for rendering on several machines and\nthe player of recordings.")
openrt_package(python python3-xvrml python "libopenrt0 ${same}, libxvrml0 ${same}, python3, python3-numpy"
  "VRML97 worlds and ray tracing for Python"
  "Loads, changes, runs and renders VRML97 worlds from Python, with numpy arrays\nfor pictures, fields and rays; and Scripts in Python for trusted worlds.")
openrt_package(doc openrt-doc doc "" "guides and examples of OpenRT, XVRML and vv"
  "How to draw boards, robots, optics and old worlds, how to write shaders, nodes\nand script engines; programs in C and Python, and the worlds that the guides\nuse.")
set(CPACK_DEBIAN_VV_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_LIBXVRML_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(CPACK_COMPONENTS_ALL ${packaged_components})

# The licence and changelog that Debian's policy requires in every package.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(debian ${CMAKE_BINARY_DIR}/package/debian)
  configure_file(cmake/debian/changelog.in ${debian}/changelog @ONLY)
  find_program(GZIP gzip)
  execute_process(COMMAND ${GZIP} -9nf ${debian}/changelog)
  foreach(component ${packaged_components})
    string(TOUPPER ${component} upper)
    set(doc ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
    install(FILES cmake/debian/copyright DESTINATION ${doc} COMPONENT ${component})
    install(FILES ${debian}/changelog.gz DESTINATION ${doc} RENAME changelog.Debian.gz COMPONENT ${component})
  endforeach()
  foreach(component libopenrt libxvrml) # refresh the list of libraries
    string(TOUPPER ${component} upper)
    file(WRITE ${debian}/${component}/triggers "activate-noawait ldconfig\n")
    set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA ${debian}/${component}/triggers)
  endforeach()
endif()
# Compresses the manual pages and strips the Python module, which is installed as a file instead of
# a target.
file(WRITE ${CMAKE_BINARY_DIR}/package/compress.cmake [=[
file(GLOB_RECURSE pages ${CPACK_TEMPORARY_DIRECTORY}/*/usr/share/man/*.[13])
if(pages)
  execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
file(GLOB_RECURSE modules ${CPACK_TEMPORARY_DIRECTORY}/*/usr/lib/python3/*.so)
if(modules)
  execute_process(COMMAND strip --strip-unneeded ${modules} COMMAND_ERROR_IS_FATAL ANY)
endif()
]=])
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_BINARY_DIR}/package/compress.cmake)
include(CPack)
