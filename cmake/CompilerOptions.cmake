# A program is the same, byte by byte, from whichever folder it is built (tests/entry/reproducible). A debug build keeps
# whole paths, for debuggers. The compiler takes the last prefix that fits.
if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}=. -ffile-prefix-map=${PROJECT_BINARY_DIR}=./build)
endif()

# Warnings and sanitizers, applied target by target: framewatch_options(<target>).
function(framewatch_options target)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wold-style-cast -Wcast-qual
    -Woverloaded-virtual -Wnon-virtual-dtor
    -fno-semantic-interposition  # a call within a library goes to the library itself, so it can be inlined
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # false alarms in g++ 12: PR 105651
    $<$<BOOL:${FRAMEWATCH_WERROR}>:-Werror>)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL EXECUTABLE)  # -fPIC as in libraries, not -fPIE: they share precompiled headers
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
  if(FRAMEWATCH_SANITIZE)
    # vptr: g++ 12 miscompiles its own check where lcm-cpp.hpp calls a handler by member pointer.
    # null, alignment, object-size: instrument every access, and the address sanitizer sees most of
    # it; the build takes half as long without.
    target_compile_options(${target} PUBLIC -fsanitize=${FRAMEWATCH_SANITIZE}
      -fno-sanitize=vptr,null,alignment,object-size -fno-sanitize-recover=all
      -fno-omit-frame-pointer)
    # Eigen takes malloc's alignment for granted with glibc, but not under a sanitizer: rooms with and without
    # one must allocate alike.
    target_compile_definitions(${target} PUBLIC _GLIBCXX_ASSERTIONS EIGEN_MALLOC_ALREADY_ALIGNED=1)
    target_link_options(${target} PUBLIC -fsanitize=${FRAMEWATCH_SANITIZE})
    # Tests start programs thousands of times. At a fixed address a start has 350,000 relocations less,
    # a third of its time. The thread sanitizer needs -pie.
    if(type STREQUAL EXECUTABLE AND FRAMEWATCH_SANITIZE MATCHES address)
      target_link_options(${target} PRIVATE -no-pie)
    endif()
  endif()
endfunction()
