# Defines the installation folders. Below a prefix they follow GNUInstallDirs; the Python package is
# in OPENRT_PYTHON_DIR, by default lib/openrt/python, where the engine for Scripts in Python finds
# it. In a wheel the package itself is the prefix, and there are no links.
if(OPENRT_WHEEL)
  set(OPENRT_WINDOW OFF) # SDL needs a desktop's libraries, which a wheel cannot bring
  set(OPENRT_SERVER OFF) # libwebsockets links a TLS library
  set(OPENRT_FILMS OFF) # Debian's ffmpeg links a hundred libraries
  set(OPENRT_STEP OFF) # Open CASCADE is larger than all the rest
  set(CMAKE_INSTALL_LIBDIR lib)
  set(CMAKE_INSTALL_BINDIR bin)
  set(CMAKE_INSTALL_LIBEXECDIR libexec)
  set(CMAKE_INSTALL_INCLUDEDIR include)
  set(CMAKE_INSTALL_DATADIR share)
endif()
include(GNUInstallDirs)
set(OPENRT_PYTHON_DIR ${CMAKE_INSTALL_LIBDIR}/openrt/python CACHE STRING "Where the Python package is installed, below the prefix")
if(OPENRT_WHEEL)
  set(openrt_python_place .)
else()
  set(openrt_python_place ${OPENRT_PYTHON_DIR}/xvrml)
endif()
# Relative path from the Python package to the libraries.
cmake_path(SET openrt_python_to_lib NORMALIZE /${CMAKE_INSTALL_LIBDIR})
cmake_path(RELATIVE_PATH openrt_python_to_lib BASE_DIRECTORY /${openrt_python_place})

# openrt_shared_library(TARGET): sets the versioned names of a library of the project.
function(openrt_shared_library target)
  set_target_properties(${target} PROPERTIES SOVERSION 0)
  if(NOT OPENRT_WHEEL) # a wheel cannot contain links: the file itself has the soname
    set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION})
  endif()
endfunction()
