# A quarter of a build is other people's headers. Off where a missing #include must be seen: everywhere
# but in the sanitizer build, which ./test makes beside one without.
set(framewatch_standard_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream>
  <functional> <map> <memory> <mutex> <numeric> <optional> <string> <thread> <utility> <vector>)

# framewatch_precompile(<target> <header>...): these and the standard library's.
function(framewatch_precompile target)
  if(FRAMEWATCH_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${framewatch_standard_headers} ${ARGN})
  endif()
endfunction()

# framewatch_precompile_like(<target> <other>): what was made for another target of the same flags.
function(framewatch_precompile_like target other)
  if(FRAMEWATCH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()
