# openrt_precompile(TARGET HEADER...): with OPENRT_PRECOMPILED_HEADERS=ON, lets the compiler read the
# headers of the standard library that most files include, and those given, once for the target instead
# of once for each file. A compiler cache gives more and cannot reuse such headers: set -DCCACHE= with it.
# GCC 12 warns of headers of the system that it has read so: set -DOPENRT_WERROR=OFF, too.
option(OPENRT_PRECOMPILED_HEADERS "Read common headers once for each target" OFF)

set(standard_headers
    algorithm array atomic bit charconv chrono cmath condition_variable cstddef cstdint cstdio cstdlib cstring deque
    filesystem fstream functional limits map memory mutex numbers optional set span stdexcept string string_view
    thread unordered_map unordered_set utility variant vector)

function(openrt_precompile target)
  if(OPENRT_PRECOMPILED_HEADERS)
    foreach(header ${standard_headers} ${ARGN})
      target_precompile_headers(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:<${header}$<ANGLE-R>>)
    endforeach()
  endif()
endfunction()
