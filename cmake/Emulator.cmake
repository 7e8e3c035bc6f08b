# framewatch_runnable(<variable> <target>): sets the variable in all folders to a command that runs a program of this
# build on this machine: the program itself or, in a cross build, a script that calls the emulator.
function(framewatch_runnable variable target)
  set(command $<TARGET_FILE:${target}>)
  if(CMAKE_CROSSCOMPILING)
    set(command ${CMAKE_BINARY_DIR}/run-${target})
    list(JOIN CMAKE_CROSSCOMPILING_EMULATOR " " emulator)
    file(GENERATE OUTPUT ${command} CONTENT "#!/bin/sh\nexec ${emulator} $<TARGET_FILE:${target}> \"$@\"\n"
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endif()
  set(${variable} ${command} CACHE INTERNAL "command that runs ${target}")
endfunction()
