# framewatch_room(<folder> [LINKS <library>...] [PUBLIC <library>...] [PLAIN]): the sources of one folder as a
# library named as the folder, "_" for "/". Rooms are declared lowest first: each sees those declared
# before it and no others, which tests/purity checks include by include. PUBLIC: libraries that whoever
# uses the room sees too. PLAIN: the room only computes; it reads no foreign bytes and runs no threads, so it and
# its tests have no sanitizer unless FRAMEWATCH_SANITIZE_ALL is set. Where FRAMEWATCH_LEAVE_OUT is set, the room only
# has its place in the order.
function(framewatch_room folder)
  set_property(GLOBAL APPEND PROPERTY FRAMEWATCH_ROOM_ORDER ${folder})
  if(FRAMEWATCH_LEAVE_OUT)
    return()
  endif()
  cmake_parse_arguments(ARG "PLAIN" "" "LINKS;PUBLIC" ${ARGN})
  string(REPLACE "/" "_" room ${folder})
  get_property(lower GLOBAL PROPERTY FRAMEWATCH_HIGHEST_ROOM)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  if(sources)
    add_library(${room} STATIC ${sources})
    target_link_libraries(${room} PUBLIC ${lower} ${ARG_PUBLIC} PRIVATE ${ARG_LINKS})
    framewatch_options(${room})
    if(ARG_PLAIN)
      framewatch_make_plain(${room})
    endif()
  else()
    add_library(${room} INTERFACE)
    target_link_libraries(${room} INTERFACE ${lower} ${ARG_PUBLIC})
    target_include_directories(${room} INTERFACE ${PROJECT_SOURCE_DIR})
  endif()
  set_property(GLOBAL PROPERTY FRAMEWATCH_HIGHEST_ROOM ${room})
  set_property(GLOBAL APPEND PROPERTY FRAMEWATCH_ROOMS ${folder})
endfunction()

# framewatch_make_plain(<target>...): compiles these targets without the sanitizers of the others, unless
# FRAMEWATCH_SANITIZE_ALL is set.
function(framewatch_make_plain)
  if(NOT FRAMEWATCH_SANITIZE OR FRAMEWATCH_SANITIZE_ALL)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -fno-sanitize=all)
  endforeach()
  set_property(GLOBAL APPEND PROPERTY FRAMEWATCH_PLAIN ${ARGN})
endfunction()

# framewatch_rooms_of(<folder> <variable>): targets of the rooms in a folder that have sources.
function(framewatch_rooms_of folder variable)
  get_property(rooms GLOBAL PROPERTY FRAMEWATCH_ROOMS)
  list(FILTER rooms INCLUDE REGEX "^${folder}/")
  list(TRANSFORM rooms REPLACE "/" "_")
  set(found "")
  foreach(room IN LISTS rooms)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      list(APPEND found ${room})
    endif()
  endforeach()
  set(${variable} ${found} PARENT_SCOPE)
endfunction()
