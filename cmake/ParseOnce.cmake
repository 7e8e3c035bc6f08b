# Most of a build is headers, read again for every source. Off where a missing #include must be seen:
# everywhere but in the sanitizer build, which ./test makes beside one without.
set(framewatch_standard_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream>
  <functional> <map> <memory> <mutex> <numeric> <optional> <string> <thread> <utility> <vector>)

# framewatch_precompile(<target> <header>...): these and the standard library's.
function(framewatch_precompile target)
  if(FRAMEWATCH_PARSE_ONCE)
    target_precompile_headers(${target} PRIVATE ${framewatch_standard_headers} ${ARGN})
  endif()
endfunction()

# framewatch_precompile_like(<target> <other>): what was made for another target of the same flags.
function(framewatch_precompile_like target other)
  if(FRAMEWATCH_PARSE_ONCE)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# framewatch_join(<target>): its sources are compiled eight at a time: a third of the time in the
# daemon, no gain in the estimator, which is Eigen. What they name in a namespace without a name must
# then differ from one source to the next.
function(framewatch_join target)
  if(FRAMEWATCH_PARSE_ONCE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  endif()
endfunction()
