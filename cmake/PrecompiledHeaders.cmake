# openrt_precompile(TARGET HEADER...): lets the compiler read the headers of the standard library that
# most files include, and those given, once for the target instead of once for each file. A first build
# takes a quarter less time with it. A compiler cache gives more to the builds that follow and cannot
# reuse such headers, so where there is one, this is off.
if(CCACHE)
  set(without_cache OFF)
else()
  set(without_cache ON)
endif()
option(OPENRT_PRECOMPILED_HEADERS "Read common headers once for each target" ${without_cache})

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
