# Most of a build is headers, read again for every source. FRAMEWATCH_PRECOMPILE reads those of other
# people once (tests/purity/check-missing-includes sees what the compiler then does not);
# FRAMEWATCH_JOIN compiles the sources of a room as one, so is off in the preset dev, where a missing
# #include of ours must be seen.
set(framewatch_standard_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream>
  <functional> <map> <memory> <mutex> <numeric> <optional> <set> <string> <thread> <utility> <vector>)

# framewatch_precompile(<name> LINKS <library>... HEADERS <header>... FOR <target>... OPTIONS <option>...):
# these headers and the standard library's, read once for all targets, which are compiled with the
# options that users of LINKS have and with OPTIONS; once more as plain_<name> for targets without sanitizers.
function(framewatch_precompile name)
  cmake_parse_arguments(ARG "" "" "LINKS;HEADERS;FOR;OPTIONS" ${ARGN})
  if(NOT FRAMEWATCH_PRECOMPILE)
    return()
  endif()
  get_property(plain GLOBAL PROPERTY FRAMEWATCH_PLAIN)
  foreach(target IN LISTS ARG_FOR)
    set(headers ${name})
    if(target IN_LIST plain)
      set(headers plain_${name})
    endif()
    if(NOT TARGET ${headers})
      set(source ${CMAKE_CURRENT_BINARY_DIR}/${headers}.cpp)
      file(CONFIGURE OUTPUT ${source} CONTENT "")
      add_library(${headers} OBJECT ${source})
      target_link_libraries(${headers} PRIVATE ${ARG_LINKS})
      framewatch_options(${headers})
      target_compile_options(${headers} PRIVATE ${ARG_OPTIONS})
      if(target IN_LIST plain)
        framewatch_make_plain(${headers})
      endif()
      target_precompile_headers(${headers} PRIVATE ${framewatch_standard_headers} ${ARG_HEADERS})
    endif()
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endforeach()
endfunction()

# framewatch_join(<target>...): the sources of each are compiled as one. What they name in a namespace
# without a name must then differ from one source to the next.
function(framewatch_join)
  if(FRAMEWATCH_JOIN)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
endfunction()
