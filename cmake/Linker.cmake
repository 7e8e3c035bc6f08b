# Fifty programs of tests: lld links each in a quarter of what GNU ld takes.
find_program(FRAMEWATCH_LLD ld.lld)
if(FRAMEWATCH_LLD AND NOT CMAKE_CROSSCOMPILING)  # a cross compiler finds no linker but its own
  add_link_options(-fuse-ld=lld)
endif()
# A program needs the libraries whose functions it calls, and a shared library names all that it calls. The sanitizers'
# functions come from the program, so a shared library with sanitizers may leave them undefined.
add_link_options(-Wl,--as-needed)
if(NOT FRAMEWATCH_SANITIZE)
  add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>:-Wl,--no-undefined>)
endif()
