# The estimator as a library for other programs (docs/library.md): libframewatch_estimator.so and .a, which other
# targets do not use. `cmake --build BUILD --target framewatch_library` builds both, and
# `cmake --install BUILD --component library` installs them. Other installations leave them out.

# The public API: these headers and no others. They include only one another.
set(FRAMEWATCH_PUBLIC_HEADERS
  estimator/identify/estimate/estimate.h
  estimator/motion/axis_counters.h
  estimator/motion/pulled.h
  estimator/motion/sample.h
  estimator/pipeline/pipeline.h
  estimator/pipeline/pipeline_size.h
  estimator/setup/pipeline_config.h
  estimator/state/abi.h
  estimator/state/archive.h
  estimator/structure/parameter_table.h
  estimator/structure/sensors.h
  estimator/structure/story_groups.h
  estimator/structure/structure.h)
# The number of the binary interface: in the SONAME, and in the version of every symbol. deploy/library/symbols.map
# lists the symbols.
set(FRAMEWATCH_ABI 0)

# framewatch_objects_of_library(<variable>): objects of the rooms up to estimator/pipeline, none with a sanitizer.
function(framewatch_objects_of_library variable)
  get_property(folders GLOBAL PROPERTY FRAMEWATCH_ROOMS)
  get_property(plain GLOBAL PROPERTY FRAMEWATCH_PLAIN)
  set(objects "")
  foreach(folder IN LISTS folders)
    string(REPLACE "/" "_" room ${folder})
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      if(FRAMEWATCH_SANITIZE AND NOT room IN_LIST plain)  # compiled once more
        file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
        add_library(${room}_plain OBJECT ${sources})
        target_link_libraries(${room}_plain PRIVATE Eigen3::Eigen)
        framewatch_options(${room}_plain)
        target_compile_options(${room}_plain PRIVATE -ffp-contract=off ${FRAMEWATCH_ESTIMATOR_OPTIMISATION}
          -fno-sanitize=all)
        framewatch_join(${room}_plain)
        if(FRAMEWATCH_PRECOMPILE)
          target_precompile_headers(${room}_plain REUSE_FROM plain_estimator_headers)
        endif()
        string(APPEND room _plain)
      endif()
      list(APPEND objects $<TARGET_OBJECTS:${room}>)
    endif()
    if(folder STREQUAL estimator/pipeline)
      break()
    endif()
  endforeach()
  set(${variable} ${objects} PARENT_SCOPE)
endfunction()

function(framewatch_add_library)
  if(FRAMEWATCH_SANITIZE_ALL OR FRAMEWATCH_SANITIZE MATCHES "thread|fuzzer")
    message(STATUS "no target framewatch_library: every room has a sanitizer")
    return()
  endif()
  # Packages promise this alignment to programs, whatever their options are.
  include(CheckCXXSourceCompiles)
  set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
  set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
  check_cxx_source_compiles("
    #include <Eigen/Core>
    static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MALLOC_ALREADY_ALIGNED == 1);
    " FRAMEWATCH_EIGEN_ALIGNS_TO_16)
  if(NOT FRAMEWATCH_EIGEN_ALIGNS_TO_16)
    message(STATUS "no target framewatch_library: CMAKE_CXX_FLAGS='${CMAKE_CXX_FLAGS}' changes Eigen's alignment "
      "from 16 bytes; leave out -march, -mavx and the like")
    return()
  endif()

  set(map ${PROJECT_SOURCE_DIR}/deploy/library/symbols.map)
  framewatch_objects_of_library(objects)
  add_library(framewatch_shared SHARED ${objects})
  set_target_properties(framewatch_shared PROPERTIES OUTPUT_NAME framewatch_estimator LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${FRAMEWATCH_ABI} LINK_DEPENDS ${map})
  target_link_options(framewatch_shared PRIVATE -Wl,--no-undefined -Wl,--version-script=${map})

  # The archive has one object, in which only the public symbols are global. Otherwise the linker could take
  # Eigen's inline functions for the library from a program that was compiled with other options. objcopy makes a
  # unique symbol (a static variable of an inline function) local only if it is weak.
  set(archive ${CMAKE_CURRENT_BINARY_DIR}/libframewatch_estimator.a)
  set(merged ${CMAKE_CURRENT_BINARY_DIR}/framewatch_estimator.o)
  set(public ${CMAKE_CURRENT_BINARY_DIR}/public-symbols.txt)
  set(unique ${CMAKE_CURRENT_BINARY_DIR}/unique-symbols.txt)
  file(STRINGS ${map} symbols REGEX "^ *_Z")
  list(TRANSFORM symbols REPLACE "^ *(_Z[A-Za-z0-9_]+);.*" "\\1")
  list(JOIN symbols "\n" lines)
  file(CONFIGURE OUTPUT ${public} CONTENT "${lines}\n" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${map})
  set(sysroot "")
  if(CMAKE_SYSROOT)
    set(sysroot --sysroot=${CMAKE_SYSROOT})
  endif()
  add_custom_command(OUTPUT ${archive}
    COMMAND ${CMAKE_CXX_COMPILER} ${sysroot} -r -nostdlib -fno-lto -fuse-ld=bfd -Wl,--force-group-allocation
      -o ${merged} ${objects}
    COMMAND sh -c "\"$1\" \"$2\" | sed -n 's/.* u //p' >\"$3\"" - ${CMAKE_NM} ${merged} ${unique}
    COMMAND ${CMAKE_OBJCOPY} --weaken-symbols=${unique} ${merged}
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbols=${public} ${merged}
    COMMAND ${CMAKE_COMMAND} -E rm -f ${archive}
    COMMAND ${CMAKE_AR} qcsD ${archive} ${merged}
    DEPENDS ${objects} ${public} COMMAND_EXPAND_LISTS VERBATIM COMMENT "Linking libframewatch_estimator.a")
  add_custom_target(framewatch_library ALL DEPENDS ${archive} framewatch_shared)
  framewatch_install_library(${archive})
endfunction()

function(framewatch_install_library archive)
  include(GNUInstallDirs)
  include(CMakePackageConfigHelpers)
  set(component COMPONENT library EXCLUDE_FROM_ALL)
  install(TARGETS framewatch_shared LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${component})
  install(FILES ${archive} DESTINATION ${CMAKE_INSTALL_LIBDIR} ${component})
  install(CODE "
    set(source \"${PROJECT_SOURCE_DIR}\")
    set(headers \"${FRAMEWATCH_PUBLIC_HEADERS}\")
    set(eigen \"${Eigen3_VERSION}\")
    set(destination \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/framewatch\")
    include(\"${PROJECT_SOURCE_DIR}/cmake/InstallHeaders.cmake\")" ${component})

  set(made ${CMAKE_CURRENT_BINARY_DIR}/library)
  set(templates ${PROJECT_SOURCE_DIR}/deploy/library)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/framewatch)
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" eigen ${Eigen3_VERSION})
  string(REGEX MATCH "^[0-9]+" eigen_world ${eigen})
  string(REGEX MATCH "[0-9]+$" eigen_major ${eigen})
  math(EXPR eigen_next "${eigen_major} + 1")
  set(eigen_next ${eigen_world}.${eigen_next})
  file(RELATIVE_PATH up_from_package /${package} /)
  file(RELATIVE_PATH up_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" up_from_package ${up_from_package})
  string(REGEX REPLACE "/$" "" up_from_pkgconfig ${up_from_pkgconfig})
  configure_file(${templates}/framewatch-config.cmake.in ${made}/framewatch-config.cmake @ONLY)
  write_basic_package_version_file(${made}/framewatch-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${made}/framewatch-config.cmake ${made}/framewatch-config-version.cmake
    DESTINATION ${package} ${component})
  set(libraries "-L\${libdir} -lframewatch_estimator")
  configure_file(${templates}/framewatch.pc.in ${made}/framewatch.pc @ONLY)
  set(libraries "\${libdir}/libframewatch_estimator.a")
  configure_file(${templates}/framewatch.pc.in ${made}/framewatch-static.pc @ONLY)
  install(FILES ${made}/framewatch.pc ${made}/framewatch-static.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${component})
endfunction()

# `--target reference`: HTML pages of the public headers. A comment that is missing or wrong is an error.
find_program(FRAMEWATCH_DOXYGEN doxygen)
if(FRAMEWATCH_DOXYGEN)
  list(JOIN FRAMEWATCH_PUBLIC_HEADERS " " headers)
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E env FRAMEWATCH_HEADERS=${headers} FRAMEWATCH_VERSION=${PROJECT_VERSION}
      FRAMEWATCH_REFERENCE=${PROJECT_BINARY_DIR}/reference ${FRAMEWATCH_DOXYGEN} deploy/library/Doxyfile
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
endif()
framewatch_add_library()
