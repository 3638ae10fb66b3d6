# cmake -DNM=nm -DISA=avx2 "-DOBJECTS=a.o|b.o" -P check.cmake
#
# Every symbol that an object compiled for one instruction set offers to the linker must name that set. Of
# several weak copies of a function the linker keeps any one: a copy with this object's instructions must
# never serve the rest of the program.

find_program(nm NAMES "${NM}" nm)
if(NOT nm)
  message(STATUS "nm is absent")
  return()
endif()
string(REPLACE "|" ";" objects "${OBJECTS}")
list(LENGTH objects object_count)
if(object_count LESS 4)
  message(FATAL_ERROR "four modules are compiled for ${ISA}, but these are the objects: ${OBJECTS}")
endif()

set(count 0)
set(strangers "")
foreach(object IN LISTS objects)
  execute_process(COMMAND ${nm} -C --defined-only --extern-only ${object}
    OUTPUT_VARIABLE listing RESULT_VARIABLE status ENCODING NONE)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${nm} cannot read ${object}")
  endif()
  # CMake's lists are separated by ";" and know brackets; symbols may hold either.
  string(REGEX REPLACE "[];[]" "?" listing "${listing}")
  string(REPLACE "\n" ";" lines "${listing}")
  set(own 0)
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^[0-9a-f]+ ([A-Za-z]) (.*)$")
      continue()
    endif()
    set(type ${CMAKE_MATCH_1})
    set(symbol "${CMAKE_MATCH_2}")
    if(type MATCHES "[uVvRDB]") # data, which holds no instructions
      continue()
    endif()
    math(EXPR own "${own} + 1")
    # Whole words: the namespace of this project, or Highway's for the set.
    if(NOT symbol MATCHES "(^|[^A-Za-z0-9_])${ISA}::")
      list(APPEND strangers "${object}: ${line}")
    endif()
  endforeach()
  if(own EQUAL 0)
    message(FATAL_ERROR "${object} defines nothing: was it compiled for ${ISA}?")
  endif()
  math(EXPR count "${count} + ${own}")
endforeach()
message(STATUS "${count} symbols of ${object_count} objects for ${ISA}")
if(strangers)
  list(JOIN strangers "\n  " strangers)
  message(FATAL_ERROR "the linker may give these to processors without ${ISA}:\n  ${strangers}")
endif()
