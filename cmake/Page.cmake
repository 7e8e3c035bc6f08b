# framewatch_page(<target> <folder> <template> <file>...): files of a page become part of a library, without
# indentation and comments (// and a space): entries of a map from "/name" to type and content stand for @web_entries@ in
# the template.
function(framewatch_page target folder template)
  set(types html "text/html\; charset=utf-8" css "text/css\; charset=utf-8"
    js "text/javascript\; charset=utf-8" svg image/svg+xml)
  set(web_entries "")
  foreach(name IN LISTS ARGN)
    file(READ ${folder}/${name} content)
    string(REGEX REPLACE "\n +" "\n" content "${content}")
    string(REGEX REPLACE "\n//[^\n]*| +// [^\n]*" "" content "${content}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
      ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/${name})
    string(REGEX MATCH "[a-z]+$" ending ${name})
    list(FIND types ${ending} at)
    math(EXPR at "${at} + 1")
    list(GET types ${at} type)
    string(APPEND web_entries "    {\"/${name}\", {\"${type}\", R\"~page~(${content})~page~\"}},\n")
  endforeach()
  string(REGEX REPLACE "\\.in$" "" source ${template})
  get_filename_component(layer ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  configure_file(${template} ${CMAKE_CURRENT_BINARY_DIR}/generated/${layer}/${source} @ONLY)
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated/${layer}/${source})
endfunction()
