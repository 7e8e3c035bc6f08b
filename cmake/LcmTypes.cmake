# Debian's LCM ships neither a CMake package nor lcm_wrap_types, and its pkg-config file needs
# glib's: find it by hand, and generate one header per .lcm file.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
find_program(AWK awk REQUIRED)
set(lcm_layouts ${CMAKE_CURRENT_LIST_DIR}/lcm-layouts.awk)

if(NOT TARGET lcm::lcm)
  add_library(lcm::lcm UNKNOWN IMPORTED)
  set_target_properties(lcm::lcm PROPERTIES IMPORTED_LOCATION ${LCM_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()

# framewatch_lcm_types(<target> <package> <file>...): interface library with the generated headers,
# included as <package/name.hpp>, and the layouts of all these messages, <package/message_layouts.hpp>; a
# system include, because generated code is not held to our flags.
function(framewatch_lcm_types target package)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(headers)
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME_WE)
    set(header ${out}/${package}/${name}.hpp)
    add_custom_command(OUTPUT ${header}
      COMMAND ${LCM_GEN} --cpp --cpp-std=c++11 --cpp-hpath ${out}
              ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      DEPENDS ${file} COMMENT "lcm-gen ${file}" VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
  set(header ${out}/${package}/message_layouts.hpp)
  add_custom_command(OUTPUT ${header}
    COMMAND ${AWK} -f ${lcm_layouts} -v out=${header} ${files}
    DEPENDS ${files} ${lcm_layouts} COMMENT "layouts of the messages" VERBATIM)
  list(APPEND headers ${header})
  add_custom_target(${target}_headers DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} SYSTEM INTERFACE ${out} ${LCM_INCLUDE_DIR})
  # LCM's own headers write doubles through int64_t pointers; with strict aliasing g++ 12 drops the
  # doubles at -O2 and every sample leaves as 0.
  target_compile_options(${target} INTERFACE -fno-strict-aliasing)
endfunction()
