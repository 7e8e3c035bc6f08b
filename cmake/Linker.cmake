# Fifty programs of tests: lld links each in a quarter of what GNU ld takes.
find_program(FRAMEWATCH_LLD ld.lld)
if(FRAMEWATCH_LLD AND NOT CMAKE_CROSSCOMPILING)  # a cross compiler finds no linker but its own
  add_link_options(-fuse-ld=lld)
endif()
