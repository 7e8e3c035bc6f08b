# Fifty programs of tests: lld links each in a quarter of what GNU ld takes.
find_program(FRAMEWATCH_LLD ld.lld)
if(FRAMEWATCH_LLD)
  add_link_options(-fuse-ld=lld)
endif()
