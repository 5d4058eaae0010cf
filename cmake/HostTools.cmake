# Sets XVRML_NODEGEN to the nodegen that runs while the project is built: the target `nodegen`, or in
# a cross build a program for the machine that builds. That one is either given (OPENRT_NODEGEN) or
# built by cmake/host with that machine's compiler ($CXX_FOR_BUILD). flatc is always
# the one of the machine that builds (Dependencies.cmake).
set(OPENRT_NODEGEN "" CACHE FILEPATH "A nodegen of this version that runs on the machine that builds; a cross build without it builds one")
if(OPENRT_NODEGEN)
  set(XVRML_NODEGEN ${OPENRT_NODEGEN})
elseif(NOT CMAKE_CROSSCOMPILING)
  set(XVRML_NODEGEN nodegen)
else()
  include(ExternalProject)
  set(XVRML_NODEGEN ${CMAKE_BINARY_DIR}/host/nodegen)
  set(host_environment --unset=CC --unset=CXX --unset=CFLAGS --unset=CXXFLAGS --unset=CPPFLAGS --unset=LDFLAGS
      --unset=PKG_CONFIG_SYSROOT_DIR --unset=PKG_CONFIG_LIBDIR)
  set(host_options -DCMAKE_BUILD_TYPE=Release)
  if(DEFINED ENV{CXX_FOR_BUILD})
    list(APPEND host_options -DCMAKE_CXX_COMPILER=$ENV{CXX_FOR_BUILD})
  endif()
  ExternalProject_Add(host_tools
    SOURCE_DIR ${CMAKE_SOURCE_DIR}/cmake/host BINARY_DIR ${CMAKE_BINARY_DIR}/host
    CONFIGURE_COMMAND ${CMAKE_COMMAND} -E env ${host_environment} ${CMAKE_COMMAND} -G ${CMAKE_GENERATOR} ${host_options}
                      -S ${CMAKE_SOURCE_DIR}/cmake/host -B ${CMAKE_BINARY_DIR}/host
    BUILD_COMMAND ${CMAKE_COMMAND} -E env ${host_environment} ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR}/host
    INSTALL_COMMAND "" BUILD_ALWAYS ON BUILD_BYPRODUCTS ${XVRML_NODEGEN})
endif()
